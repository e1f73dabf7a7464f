#pragma once

#include "core/standard/motion_prior.hpp"

namespace lilo::standard {

/// What the ground does to the vehicle, learnt on the way: power densities of how it rocks and
/// heaves. Between a car on asphalt and a stiff robot on cobbles lies a factor of hundreds.
/// Believed too calm, the end of every scan lags behind; too wild, it follows each error of the few
/// returns that saw it.
///
/// A scan sees its end from one side only. The next one begins there and corrects it. When the
/// correction goes where the end would have gone had more unrest been believed in, there is more:
/// a step down the slope of the squared correction, which asks nothing of the noise or of the
/// spectrum of the motion. What the next scan says is asked with the wildest motion believed in: of
/// wheels that hop once a turn, calm takes from its beginning what it took from the end before, and
/// the two agree. Calm is believed slowly and never far, a surprise at once: a robot that stood for
/// a minute sets off on cobbles. What the driver does, yaw and speed, is left as configured:
/// learning it the same way made nothing better.
class Unrest {
 public:
  /// `usual`: densities of all axes, kept but for those of the unrest, where learning begins.
  explicit Unrest(const Vector6d& usual) : usual_(usual) {}

  /// `correction`: by how much a scan moves the end of the one before, seen so; `end_by_unrest`: by
  /// how much that end goes with the logarithm of each density. Both rotation, translation (rad,
  /// m). `surprise`: the scan's own.
  void learn(const Vector6d& correction, const EndByUnrest& end_by_unrest,
             const PerUnrest& surprise);

  /// Rotation (rad^2/s^3), translation (m^2/s^3).
  [[nodiscard]] Vector6d density() const;
  /// The most that may be learnt.
  [[nodiscard]] Vector6d wildest_density() const;

 private:
  [[nodiscard]] Vector6d density_at(const PerUnrest& log_ratio) const;

  Vector6d usual_;
  PerUnrest log_ratio_ = PerUnrest::Zero();  // to the usual density
  // Squares, as of late.
  PerUnrest correction2_ = PerUnrest::Zero(), change2_ = PerUnrest::Zero();
};

}  // namespace lilo::standard
