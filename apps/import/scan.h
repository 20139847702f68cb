#pragma once

#include <cstddef>
#include <span>

/// \file
/// A look over a file before an importer that recurses gets it. Each throws a Refusal for what would take
/// its stack or time, and lets everything else pass: the importer judges the rest.

namespace hooke::importer {

/// Chunks of a .3ds: how many, how deep they nest, and how deep its keyframer stacks nodes.
void scan_3ds(std::span<const std::byte> bytes);

/// The JSON of a .gltf: how deep it nests, and how deep its nodes do.
void scan_gltf(std::span<const std::byte> bytes);

/// The same for the first chunk of a .glb.
void scan_glb(std::span<const std::byte> bytes);

/// The header of a .ply: that it ends, and promises no more than there is.
void scan_ply(std::span<const std::byte> bytes);

/// The faces of an .obj: each has corners.
void scan_obj(std::span<const std::byte> bytes);

}  // namespace hooke::importer
