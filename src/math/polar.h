#pragma once

#include "hooke/math.h"

namespace hooke::math {

/// Returns the rotation R for which tr(R^T A) is largest. For A = sum m p q^T, R brings the q nearest to the
/// p. Where det A > 0 it is the rotation of the polar decomposition A = R S; where A mirrors, it is the
/// nearest proper rotation.
///
/// The unit quaternion is the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix N (Horn
/// 1987). This eigenvalue is the largest root of lambda^4 - 2 |A|^2 lambda^2 - 8 det A lambda + det N, found
/// by a fixed number of Newton steps from above (Theobald 2005). No state is kept between calls.
///
/// Where several rotations are equally near, as for A = 0, the result is one of them.
[[nodiscard]] Quaternion<double> closest_rotation(const Matrix3<double>& a);

}  // namespace hooke::math
