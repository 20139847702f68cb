#pragma once

/// \file
/// The version of the engine that a program is compiled with. Before 1.0 a minor version may break what was
/// there; a patch breaks nothing. The numbers are macros so that a program can choose its code by them:
///
///     #if HOOKE_VERSION_MAJOR > 0 || HOOKE_VERSION_MINOR >= 2
///
/// The root CMakeLists.txt refuses to configure if they are not those of the project.

#define HOOKE_VERSION_MAJOR 0  ///< It grows when programs must change.
#define HOOKE_VERSION_MINOR 1  ///< It grows with what is new.
#define HOOKE_VERSION_PATCH 0  ///< It grows with what is mended.

namespace hooke {

/// The three numbers with points between, as `hooke --version` and every report show them.
inline constexpr const char* kVersion = "0.1.0";

}  // namespace hooke
