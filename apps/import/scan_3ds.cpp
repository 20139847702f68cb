#include "limits.h"
#include "refusal.h"
#include "scan.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <unordered_map>
#include <vector>

namespace hooke::importer {

namespace {

using io::ImporterExit;

constexpr std::size_t kHeaderSize = 6;
constexpr std::size_t kMaxChunks = 1000000;
constexpr std::size_t kMaxChunkDepth = 64;
// Siblings of a kind that the importer takes one by one by recursion.
constexpr std::size_t kMaxSiblings = 4096;

enum ChunkKind : std::uint16_t {
  kMain = 0x4D4D,
  kEditor = 0x3D3D,
  kObject = 0x4000,
  kMesh = 0x4100,
  kFaces = 0x4120,
  kMaterial = 0xAFFF,
  kKeyframer = 0xB000,
  kFirstTrack = 0xB001,
  kNodeTrack = 0xB002,
  kLastTrack = 0xB007,
  kNodeName = 0xB010,
};

struct Chunk {
  std::uint16_t kind = 0;
  std::size_t first = 0;  ///< Begin of its content.
  std::size_t last = 0;   ///< End of its content.
};

std::uint16_t word_at(std::span<const std::byte> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[at]) |
                                    std::to_integer<unsigned>(bytes[at + 1]) << 8u);
}

std::uint32_t double_word_at(std::span<const std::byte> bytes, std::size_t at) {
  return word_at(bytes, at) | static_cast<std::uint32_t>(word_at(bytes, at + 2)) << 16u;
}

std::string text_at(std::span<const std::byte> bytes, std::size_t at, std::size_t last) {
  std::string text;
  for (; at < last && bytes[at] != std::byte{0}; ++at) text += static_cast<char>(bytes[at]);
  return text;
}

/// Returns where the chunks inside `chunk` begin, or its end if it holds none.
std::size_t first_child(std::span<const std::byte> bytes, const Chunk& chunk) {
  const bool is_track = chunk.kind >= kFirstTrack && chunk.kind <= kLastTrack;
  const bool is_folder = is_track || chunk.kind == kMain || chunk.kind == kEditor || chunk.kind == kMesh ||
                         chunk.kind == kMaterial || chunk.kind == kKeyframer;
  if (is_folder || (chunk.kind >= 0xA200 && chunk.kind < 0xA300)) return chunk.first;
  if (chunk.kind == kObject) {
    return std::min(chunk.last, chunk.first + text_at(bytes, chunk.first, chunk.last).size() + 1);
  }
  if (chunk.kind == kFaces && chunk.last - chunk.first >= 2) {
    return std::min(chunk.last, chunk.first + 2 + std::size_t{8} * word_at(bytes, chunk.first));
  }
  return chunk.last;
}

/// A NodeTree is the tree of keyframer nodes as the importer builds it. A node's number says whether it
/// becomes a child of the one before it, its sibling, or goes back up.
class NodeTree {
 public:
  void add(std::uint16_t track, const std::string& name, std::uint16_t number) {
    const auto known = node_of_.find(name);
    if (known != node_of_.end() && track != kNodeTrack) {
      current_ = known->second;
      return;
    }
    const std::int32_t position = static_cast<std::uint16_t>(number + 1u);
    const std::size_t parent = find_parent(position);
    const int depth = nodes_[parent].depth + 1;
    if (depth > kMaxNodeDepth) {
      throw Refusal(ImporterExit::kLimitExceeded, "nodes stacked more than 64 deep");
    }
    if (nodes_.size() > static_cast<std::size_t>(kMaxNodeCount)) {
      throw Refusal(ImporterExit::kLimitExceeded, "more than 16384 nodes");
    }
    current_ = nodes_.size();
    nodes_.push_back({parent, position, depth});
    const auto [entry, is_new] = node_of_.try_emplace(name, current_);
    if (!is_new && nodes_[entry->second].depth < depth) entry->second = current_;
  }

 private:
  struct Node {
    std::size_t parent = 0;
    std::int32_t position = 0;
    int depth = 0;
  };

  std::size_t find_parent(std::int32_t position) {
    if (nodes_[current_].position == position) {
      ++last_;
      return nodes_[current_].parent;
    }
    if (position >= last_) {
      last_ = position;
      return current_;
    }
    ++last_;
    std::size_t above = current_;
    while (above != 0 && nodes_[above].position != position) above = nodes_[above].parent;
    return nodes_[above].parent;
  }

  std::vector<Node> nodes_ = {Node{}};  ///< The root comes first and is its own parent.
  std::unordered_map<std::string, std::size_t> node_of_;
  std::size_t current_ = 0;
  std::int32_t last_ = -1;
};

/// Walks all chunks with a stack of its own instead of recursion.
class ChunkWalk {
 public:
  explicit ChunkWalk(std::span<const std::byte> bytes) : bytes_(bytes) {
    open_.push_back({{.first = 0, .last = bytes.size()}, 0, 0});
  }

  void run() {
    while (!open_.empty()) {
      Level& level = open_.back();
      if (level.chunk.last - level.next < kHeaderSize) {
        open_.pop_back();
        continue;
      }
      const Chunk chunk = take(level);
      visit(chunk);
    }
  }

 private:
  struct Level {
    Chunk chunk;
    std::size_t next = 0;
    std::size_t recursive_count = 0;
  };

  Chunk take(Level& level) {
    const std::size_t at = level.next;
    const std::size_t size = double_word_at(bytes_, at + 2);
    if (size < kHeaderSize) throw Refusal(ImporterExit::kBadSyntax, "a chunk smaller than its header");
    if (size > bytes_.size() - at) throw Refusal(ImporterExit::kBadSyntax, "a chunk that goes past the end");
    if (++count_ > kMaxChunks) throw Refusal(ImporterExit::kLimitExceeded, "more than a million chunks");
    const bool is_recursive = level.chunk.kind == kFaces || open_.size() == 1;
    if (is_recursive && ++level.recursive_count > kMaxSiblings) {
      throw Refusal(ImporterExit::kLimitExceeded, "more than 4096 chunks in a row where one belongs");
    }
    // Old exporters write sizes a little past the parent's; then the parent's end counts.
    level.next = std::min(at + size, level.chunk.last);
    return {word_at(bytes_, at), at + kHeaderSize, level.next};
  }

  void visit(const Chunk& chunk) {
    if (chunk.kind == kNodeName) {
      const std::string name = text_at(bytes_, chunk.first, chunk.last);
      const std::size_t number = chunk.first + name.size() + 1 + 4;
      if (number + 2 <= chunk.last) nodes_.add(open_.back().chunk.kind, name, word_at(bytes_, number));
    }
    const std::size_t child = first_child(bytes_, chunk);
    if (child >= chunk.last) return;
    if (open_.size() > kMaxChunkDepth) {
      throw Refusal(ImporterExit::kLimitExceeded, "chunks nested more than 64 deep");
    }
    open_.push_back({chunk, child, 0});
  }

  std::span<const std::byte> bytes_;
  std::vector<Level> open_;
  std::size_t count_ = 0;
  NodeTree nodes_;
};

}  // namespace

void scan_3ds(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderSize || word_at(bytes, 0) != kMain) {
    throw Refusal(ImporterExit::kBadSyntax, "not a .3ds file");
  }
  ChunkWalk(bytes).run();
}

}  // namespace hooke::importer
