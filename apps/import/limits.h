#pragma once

#include <cstddef>

namespace hooke::importer {

inline constexpr std::size_t kMaxFileSize = std::size_t{256} << 20;  ///< Bytes of all files of one model.
inline constexpr std::size_t kMaxMemory = std::size_t{1} << 30;      ///< Bytes of address space.
inline constexpr unsigned kMaxCpuSeconds = 10;
inline constexpr std::size_t kMaxStack = std::size_t{8} << 20;
inline constexpr int kMaxNodeDepth = 64;     ///< Nodes from the root to a leaf.
inline constexpr int kMaxNodeCount = 16384;  ///< Nodes of one model.

/// Sanitizers need terabytes of address space for their shadow memory, and system calls for their reports.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

/// Limits memory, time, core dumps, new processes and large files for good, before anything is read. Returns
/// false if the system refuses. Under a sanitizer memory and new processes stay unlimited.
[[nodiscard]] bool enter_limits();

}  // namespace hooke::importer
