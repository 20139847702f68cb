#include "io/scene/parts_cache.h"

#include "base/hash.h"
#include "geometry/convex/convex_hull.h"
#include "io/model/model_write.h"
#include "process/new_file.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <system_error>

namespace hooke::io {

namespace {

namespace fs = std::filesystem;

// To be raised whenever decompose_convex gives other parts for the same mesh. tests/lint/compare_hashes.py,
// which reads no kept parts, tells of it.
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kPartsMax = 256;
constexpr std::uint32_t kPointsMax = 4096;  // Of one part.
constexpr std::size_t kFileMax = std::size_t{16} << 20;

struct Header {
  std::array<char, 8> magic = {'h', 'o', 'o', 'k', 'e', 'c', 'v', 'x'};
  std::uint32_t version = kVersion;
  std::uint32_t parts = 0;
  std::uint64_t key = 0;
  std::uint64_t check = 0;  // Hash of all that follows.
};
static_assert(sizeof(Header) == 32);

std::uint64_t cache_key(const MeshDesc& mesh, Real concavity_max, int parts_max) {
  base::StateHash hash;
  hash.add_word(kVersion);
  hash.add_word(sizeof(Real));
  hash.add(concavity_max);
  hash.add(parts_max);
  hash.add(mesh.positions);
  hash.add(mesh.triangles);
  return hash.value();
}

fs::path file_of(const std::string& folder, std::uint64_t key) {
  char name[32];
  std::snprintf(name, sizeof name, "%016llx.parts", static_cast<unsigned long long>(key));
  return fs::path(folder) / name;
}

std::uint64_t check_of(std::span<const std::byte> bytes) {
  base::StateHash hash;
  hash.add(std::vector<std::byte>(bytes.begin(), bytes.end()));
  return hash.value();
}

/// Takes a column off the front of the bytes; returns false if they are too few.
template <class T>
bool take(std::span<const std::byte>& bytes, std::size_t count, std::vector<T>& column) {
  if (count > bytes.size() / sizeof(T)) return false;
  column.resize(count);
  if (count > 0) std::memcpy(column.data(), bytes.data(), count * sizeof(T));
  bytes = bytes.subspan(count * sizeof(T));
  return true;
}

/// Reads a part; returns false if it is no convex body.
bool take_part(std::span<const std::byte>& bytes, MeshDesc& part) {
  std::vector<std::uint32_t> counts;
  if (!take(bytes, 2, counts) || counts[0] > kPointsMax || counts[1] > 2 * kPointsMax) return false;
  if (!take(bytes, counts[0], part.positions) || !take(bytes, counts[1], part.triangles)) return false;
  return geometry::make_convex_hull(part.positions).has_value();
}

std::vector<std::byte> read_bytes(const fs::path& path) {
  std::error_code code;
  const auto size = fs::file_size(path, code);
  if (code || size > kFileMax || size < sizeof(Header)) return {};
  std::vector<std::byte> bytes(size);
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) return {};
  return bytes;
}

}  // namespace

std::vector<MeshDesc> PartsCache::recall(const MeshDesc& mesh, Real concavity_max, int parts_max) {
  if (options_.cache.empty() || mesh.triangles.size() < kCachedTriangles) return {};
  const std::uint64_t key = cache_key(mesh, concavity_max, parts_max);
  const std::vector<std::byte> bytes = read_bytes(file_of(options_.cache, key));
  if (bytes.empty()) return {};
  Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  std::span<const std::byte> rest = std::span(bytes).subspan(sizeof(header));
  const bool is_known = header.magic == Header{}.magic && header.version == kVersion && header.key == key &&
                        header.parts <= kPartsMax && header.check == check_of(rest);
  if (!is_known) return {};
  std::vector<MeshDesc> parts(header.parts);
  for (MeshDesc& part : parts) {
    if (!take_part(rest, part)) return {};
  }
  return rest.empty() ? parts : std::vector<MeshDesc>();
}

void PartsCache::keep(const MeshDesc& mesh, Real concavity_max, int parts_max,
                      const std::vector<MeshDesc>& parts) {
  if (options_.cache.empty() || mesh.triangles.size() < kCachedTriangles) return;
  std::error_code code;
  fs::create_directories(options_.cache, code);
  Bytes body;
  for (const MeshDesc& part : parts) {
    put(body, static_cast<std::uint32_t>(part.positions.size()));
    put(body, static_cast<std::uint32_t>(part.triangles.size()));
    for (const Vec3& p : part.positions) put(body, p);
    for (const auto& t : part.triangles) put(body, t);
  }
  const std::uint64_t key = cache_key(mesh, concavity_max, parts_max);
  Bytes bytes;
  put(bytes, Header{.parts = static_cast<std::uint32_t>(parts.size()), .key = key, .check = check_of(body)});
  bytes.insert(bytes.end(), body.begin(), body.end());
  // Without the file the parts are made again, and nothing else is lost.
  (void)process::write_file(file_of(options_.cache, key).string(), bytes);
}

void PartsCache::advance(double part) {
  if (options_.progress) options_.progress("making convex parts", part);
}

}  // namespace hooke::io
