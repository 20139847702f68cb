#include "hooke/bsp.h"

#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <string_view>

namespace hooke {

namespace {

constexpr std::string_view kMagic = "HOOKEBSP";
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMostItems = 1u << 30;  // of nodes, faces or corners
// The size is in bytes.
constexpr std::size_t kHeaderSize = 24;
constexpr std::size_t kNodeSize = 48;
constexpr std::size_t kFaceSize = 12;
constexpr std::size_t kCornerSize = 24;

class Writer {
 public:
  template <class Integer>
  void put(Integer value) {
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      bytes.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xFF));
    }
  }
  void put(DVec3 v) {
    for (const double x : {v.x, v.y, v.z}) put(std::bit_cast<std::uint64_t>(x));
  }

  std::vector<std::byte> bytes = {};
};

/// Reads numbers from bytes; the caller has checked that there are enough.
class BytesReader {
 public:
  explicit BytesReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class Integer>
  Integer take() {
    Integer value = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      value |= static_cast<Integer>(std::to_integer<Integer>(rest_[i]) << (8 * i));
    }
    rest_ = rest_.subspan(sizeof(Integer));
    return value;
  }
  std::uint32_t number() { return take<std::uint32_t>(); }
  double real() { return std::bit_cast<double>(take<std::uint64_t>()); }
  DVec3 vector() {
    const double x = real();
    const double y = real();
    return {x, y, real()};
  }

 private:
  std::span<const std::byte> rest_;
};

Error file_error(std::string message) {
  return {ErrorCode::kBadSyntax, "bsp", std::move(message)};
}

Error item_error(const char* name, std::size_t index, const char* message) {
  return {ErrorCode::kBadSyntax, std::string("bsp.") + name + "[" + std::to_string(index) + "]", message};
}

/// Reads a tree with so many nodes, faces and corners, whose bytes are known to be there.
BspTree read_tree(BytesReader& reader, const std::array<std::uint32_t, 3>& counts) {
  BspTree tree;
  tree.nodes.resize(counts[0]);
  tree.faces.resize(counts[1]);
  tree.corners.resize(counts[2]);
  for (BspNode& node : tree.nodes) {
    node.normal = reader.vector();
    node.offset = reader.real();
    for (std::uint32_t* n : {&node.above, &node.below, &node.first_face, &node.face_count})
      *n = reader.number();
  }
  for (BspFace& face : tree.faces) {
    for (std::uint32_t* n : {&face.triangle, &face.first_corner, &face.corner_count}) *n = reader.number();
  }
  for (DVec3& corner : tree.corners) corner = reader.vector();
  return tree;
}

Result<void> check_nodes(const BspTree& tree) {
  std::vector<bool> has_parent(tree.nodes.size(), false);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const BspNode& node = tree.nodes[i];
    const double size = length(node.normal);
    if (!(std::fabs(size - 1) < 1e-9) || !std::isfinite(node.offset)) {
      return item_error("nodes", i, "a plane that is none");
    }
    if (node.first_face > tree.faces.size() || node.face_count > tree.faces.size() - node.first_face) {
      return item_error("nodes", i, "faces that are not there");
    }
    for (const std::uint32_t child : {node.above, node.below}) {
      if (is_bsp_leaf(child)) continue;
      if (child <= i || child >= tree.nodes.size() || has_parent[child]) {
        return item_error("nodes", i, "a child that is not there, stands before it, or is another's");
      }
      has_parent[child] = true;
    }
  }
  const auto orphan = std::find(has_parent.begin() + 1, has_parent.end(), false);
  if (orphan == has_parent.end()) return {};
  return item_error("nodes", static_cast<std::size_t>(orphan - has_parent.begin()), "no node's child");
}

/// Painter's order visits each face once, so it must lie in the plane of one node. The nodes' ranges are
/// known to be valid.
Result<void> check_owners(const BspTree& tree) {
  std::vector<bool> has_node(tree.faces.size(), false);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const auto first = has_node.begin() + tree.nodes[i].first_face;
    const auto last = first + tree.nodes[i].face_count;
    if (std::find(first, last, true) != last) return item_error("nodes", i, "faces that are another's");
    std::fill(first, last, true);
  }
  const auto stray = std::find(has_node.begin(), has_node.end(), false);
  if (stray == has_node.end()) return {};
  return item_error("faces", static_cast<std::size_t>(stray - has_node.begin()), "in no node's plane");
}

Result<void> check_faces(const BspTree& tree) {
  for (std::size_t i = 0; i < tree.faces.size(); ++i) {
    const BspFace& face = tree.faces[i];
    if (face.corner_count < 3 || face.first_corner > tree.corners.size() ||
        face.corner_count > tree.corners.size() - face.first_corner) {
      return item_error("faces", i, "fewer than three corners, or some that are not there");
    }
    if (face.triangle >= geometry::kTriangleLimit) return item_error("faces", i, "of a triangle beyond 2^25");
  }
  for (std::size_t i = 0; i < tree.corners.size(); ++i) {
    if (!is_finite(tree.corners[i])) return item_error("corners", i, "a coordinate that is not finite");
  }
  return {};
}

}  // namespace

std::vector<std::byte> save_bsp(const BspTree& tree) {
  Writer writer;
  for (const char c : kMagic) writer.put(static_cast<std::uint8_t>(c));
  for (const std::size_t count :
       {std::size_t{kVersion}, tree.nodes.size(), tree.faces.size(), tree.corners.size()}) {
    writer.put(static_cast<std::uint32_t>(count));
  }
  for (const BspNode& node : tree.nodes) {
    writer.put(node.normal);
    writer.put(std::bit_cast<std::uint64_t>(node.offset));
    for (const std::uint32_t n : {node.above, node.below, node.first_face, node.face_count}) writer.put(n);
  }
  for (const BspFace& face : tree.faces) {
    for (const std::uint32_t n : {face.triangle, face.first_corner, face.corner_count}) writer.put(n);
  }
  for (const DVec3& corner : tree.corners) writer.put(corner);
  return std::move(writer.bytes);
}

Result<BspTree> load_bsp(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderSize ||
      !std::equal(kMagic.begin(), kMagic.end(), bytes.begin(),
                  [](char c, std::byte b) { return static_cast<std::byte>(c) == b; })) {
    return file_error("not a BSP tree: it does not begin with HOOKEBSP");
  }
  BytesReader reader(bytes.subspan(kMagic.size()));
  const std::uint32_t version = reader.number();
  if (version != kVersion) {
    return file_error("version " + std::to_string(version) + "; this program reads version 1");
  }
  const std::array<std::uint32_t, 3> counts = {reader.number(), reader.number(), reader.number()};
  if (counts[0] == 0 || *std::max_element(counts.begin(), counts.end()) > kMostItems) {
    return file_error("no nodes, or more than 2^30 of something");
  }
  const std::uint64_t size = kHeaderSize + std::uint64_t{kNodeSize} * counts[0] +
                             std::uint64_t{kFaceSize} * counts[1] + std::uint64_t{kCornerSize} * counts[2];
  if (size != bytes.size()) {
    return file_error(std::to_string(bytes.size()) + " bytes; its counts ask for " + std::to_string(size));
  }
  const BspTree tree = read_tree(reader, counts);
  if (Result<void> sound = check_nodes(tree); !sound) return sound.error();
  if (Result<void> sound = check_owners(tree); !sound) return sound.error();
  if (Result<void> sound = check_faces(tree); !sound) return sound.error();
  return tree;
}

}  // namespace hooke
