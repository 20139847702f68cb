#pragma once

#include "hooke/math.h"

namespace hooke::math {

/// The rotation R for which tr(R^T A) is largest: of A = sum m p q^T the one that brings the q nearest to the
/// p. Where det A > 0 that is the rotation of the polar decomposition A = R S; where A mirrors, the nearest
/// that does not. The unit quaternion is the eigenvector of the largest eigenvalue of a symmetric 4 x 4
/// matrix (Horn 1987), which is the largest root of lambda^4 - 2 |A|^2 lambda^2 - 8 det A lambda + det N:
/// Newton's iteration from above, as many times always (Theobald 2005). Nothing is carried over from call to
/// call.
///
/// Where several rotations are equally near, as for A = 0, it is one of them.
[[nodiscard]] Quaternion<double> closest_rotation(const Matrix3<double>& a);

}  // namespace hooke::math
