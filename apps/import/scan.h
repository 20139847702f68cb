#pragma once

#include <cstddef>
#include <span>

/// \file
/// Scans a file before a recursive importer gets it. Each function throws a Refusal for what would take its
/// stack or time, and lets everything else pass, which the importer judges.

namespace hooke::importer {

/// Checks the chunks of a .3ds: how many there are, how deep they nest, and how deep its keyframer stacks
/// nodes.
void scan_3ds(std::span<const std::byte> bytes);

/// Checks the JSON of a .gltf: how deep it nests, and how deep its nodes do.
void scan_gltf(std::span<const std::byte> bytes);

/// Checks the JSON in the first chunk of a .glb.
void scan_glb(std::span<const std::byte> bytes);

/// Checks the header of a .ply: that it ends, promises no more than there is, and has faces, not strips.
void scan_ply(std::span<const std::byte> bytes);

/// Checks an .obj: it must be text of bytes, and its faces must have corners.
void scan_obj(std::span<const std::byte> bytes);

}  // namespace hooke::importer
