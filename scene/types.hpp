#pragma once
// Basic types that every room shares: small vectors and tensors, indices, the dimension of a
// problem.

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace concord {

using Index = std::int32_t;  ///< particle, node or bond number (2^31 suffices for one machine)
using Vec3 = Eigen::Vector3d;  ///< point or vector [SI]; third component 0 in plane problems
using Mat3 = Eigen::Matrix3d;  ///< second-order tensor, row i = component i

/// What the out-of-plane direction does. Plane problems lie in the plane Z = 0.
enum class Dimension { three_d, plane_strain, plane_stress };

/// Number of space dimensions in which a problem has unknowns: 3 or 2.
constexpr int space_dim(Dimension d) { return d == Dimension::three_d ? 3 : 2; }

}  // namespace concord
