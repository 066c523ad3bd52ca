#pragma once
// A typed block of the state: which chart it lives in and how the error acts on it.
//
// A block stores an *estimate* (storage coordinates) and contributes an *error* (tangent
// coordinates) to the covariance. For every chart but SE(3) both have the same length.
//
// | chart  | storage                      | tangent          | boxplus                           |
// |--------|------------------------------|------------------|-----------------------------------|
// | vector | n numbers                    | n                | x + d                             |
// | angle  | phi                          | 1                | wrap(phi + d)                     |
// | SE2    | x, y, phi                    | dx, dy, dphi     | additive in the world, phi wrapped|
// | line   | alpha, r                     | dalpha, dr       | additive, alpha wrapped           |
// | SE3    | x, y, z, qx, qy, qz, qw      | dp, dtheta (3+3) | p + dp, Exp(dtheta) R (world)     |

#include <compare>
#include <string>

#include <Eigen/Core>

namespace libslam {

enum class Chart { kVector, kAngle, kSE2, kLine, kSE3 };

/// What a change of the world frame does to a block. The right-invariant error frame needs to know.
enum class WorldRole {
  kNone,   ///< calibration, biases: not expressed in the world
  kPoint,  ///< coordinates of a point in the world (dimension 2 or 3)
  kPose,   ///< a pose in the world
  kLine,   ///< an oriented line in the plane of the world: normal at alpha [rad], n^T p = r [m]
};

/// Largest tangent and storage dimension of one block.
inline constexpr int kMaxTangent = 6;
inline constexpr int kMaxStorage = 7;

using BlockVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStorage, 1>;
using TangentVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxTangent, 1>;
using BlockMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxTangent, kMaxTangent>;
using VectorRef = Eigen::Ref<const Eigen::VectorXd>;
using MatrixRef = Eigen::Ref<const Eigen::MatrixXd>;

/// Handle of a block; stays valid until the block is removed.
struct BlockId {
  int value = -1;
  auto operator<=>(const BlockId&) const = default;
  bool valid() const { return value >= 0; }
};

/// What a block is, before it gets a place in the state.
struct BlockSpec {
  std::string name;
  Chart chart = Chart::kVector;
  int size = 1;  ///< number of coordinates; used by Chart::kVector alone
  WorldRole role = WorldRole::kNone;
};

/// Length of the error of a block.
int tangent_dimension(const BlockSpec& spec);
/// Length of the stored estimate of a block.
int storage_dimension(const BlockSpec& spec);
/// x <- x [+] d in the chart of `spec`; lengths are the caller's duty.
void boxplus(const BlockSpec& spec, Eigen::Ref<Eigen::VectorXd> x, const VectorRef& d);
/// d with b [+] d = a, angles wrapped to (-pi, pi].
TangentVector boxminus(const BlockSpec& spec, const VectorRef& a, const VectorRef& b);
/// Angle wrapped to (-pi, pi].
double wrap_angle(double angle);

}  // namespace libslam
