#include "core/standard/unrest.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace lilo::standard {
namespace {

constexpr int kSegments = 2;
constexpr int kSize = kKnotSize * (kSegments + 1);
constexpr double kSpan_s = 0.1;
constexpr int kLooks = 16;        // in each scan, at the whole pose
constexpr double kNoise = 1e-3;   // of each, rad and m
constexpr double kUnrest = 0.05;  // of the motion, rad^2/s^3 and m^2/s^3, all axes

Vector6d six(double rocking, double heaving, double other) {
  Vector6d v;
  v << rocking, rocking, other, other, other, heaving;
  return v;
}

/// What shakes the axes of both kinds of unrest, once a scan or nearly.
struct Wave {
  double amplitude = 0.0, hz = 10.0;  // rad and m
};

/// White noise on the acceleration of a pose, in exact steps, and a wave.
class Motion {
 public:
  explicit Motion(unsigned seed, const Wave& wave = {}) : rng_(seed), wave_(wave) {}
  Vector6d go_on(double dt_s) {
    // Cholesky of [dt^3/3, dt^2/2; dt^2/2, dt].
    const double rate = std::sqrt(kUnrest * dt_s), half = 0.5 * dt_s;
    const double rest = std::sqrt(kUnrest * dt_s * dt_s * dt_s / 12.0);
    for (int axis = 0; axis < 6; ++axis) {
      const double n = rate * draw();
      pose_[axis] += dt_s * rate_[axis] + half * n + rest * draw();
      rate_[axis] += n;
    }
    at_s_ += dt_s;
    return pose();
  }
  [[nodiscard]] Vector6d pose() const {
    const double wave = wave_.amplitude * std::sin(2.0 * std::numbers::pi * wave_.hz * at_s_);
    return pose_ + six(wave, wave, 0.0);
  }
  double draw() { return normal_(rng_); }

 private:
  std::mt19937 rng_;
  std::normal_distribution<double> normal_;
  Wave wave_;
  double at_s_ = 0.0;
  Vector6d pose_ = Vector6d::Zero(), rate_ = Vector6d::Zero();
};

struct Equations {
  NormalMatrix H = NormalMatrix::Zero(kSize, kSize);
  Unknowns b = Unknowns::Zero(kSize);
};

/// A scan's looks at the motion; the unknowns are the poses and rates themselves.
Equations looks_at(Motion& motion) {
  Equations data;
  constexpr double kInformation = 1.0 / (kNoise * kNoise);
  for (int look = 0; look < kLooks; ++look) {
    Vector6d seen = motion.go_on(kSpan_s / kLooks);
    for (double& value : seen) value += kNoise * motion.draw();
    const KnotWeights w = weights_at((look + 1.0) / kLooks, kSegments, kSpan_s);
    for (int i = 0; i < 4; ++i) {
      const double wi = w.weight[static_cast<std::size_t>(i)];
      data.b.segment<6>(kKnotSize * w.first + 6 * i) += wi * kInformation * seen;
      for (int j = 0; j < 4; ++j) {
        data.H.block<6, 6>(kKnotSize * w.first + 6 * i, kKnotSize * w.first + 6 * j)
            .diagonal()
            .array() += wi * w.weight[static_cast<std::size_t>(j)] * kInformation;
      }
    }
  }
  return data;
}

struct Solved {
  Unknowns x;
  EndByUnrest end_by_unrest;
  KnotInformation end_information;
  Vector6d wildest_begin;
};

Solved solve(const Prior& prior, const Equations& data) {
  Equations all = data;
  add_prior(prior, kSegments, Unknowns::Zero(kSize), all.H, all.b);
  const Eigen::LDLT<NormalMatrix> factors(all.H);
  const Unknowns x = factors.solve(all.b);
  const UnrestPull by_unrest = factors.solve(pull_of_unrest(prior, kSegments, x));
  const NormalMatrix covariance = factors.solve(NormalMatrix::Identity(kSize, kSize));
  return {x, by_unrest.middleRows<6>(kSize - kKnotSize),
          covariance.bottomRightCorner<kKnotSize, kKnotSize>().inverse(),
          wildest_begin(prior, kSegments, Unknowns::Zero(kSize), data.H, data.b)};
}

/// What came of 400 scans, in the last 300.
struct Followed {
  Eigen::Vector2d mean_log = Eigen::Vector2d::Zero();  // what is believed over kUnrest, by kind
  double rocking_rms = 0.0;                            // error of the ends
};

enum class Belief { learnt, constant };

Followed follow(Motion motion, const Vector6d& usual, Belief belief) {
  Unrest unrest(usual);
  Prior prior;
  prior.begin_information = 1e8 * KnotInformation::Identity();
  prior.wildest_density = unrest.wildest_density();
  EndByUnrest by_unrest = EndByUnrest::Zero();
  Followed out;
  for (int scan = 0; scan < 400; ++scan) {
    prior.acceleration_density = unrest.density();
    const Solved solved = solve(prior, looks_at(motion));
    const Vector6d correction = solved.wildest_begin - prior.begin_mean.head<6>();
    if (scan > 0 && belief == Belief::learnt) {
      unrest.learn(correction, by_unrest, PerUnrest::Zero());
    }
    by_unrest = solved.end_by_unrest;
    prior.begin_information = solved.end_information;
    prior.begin_mean = solved.x.tail<kKnotSize>();
    if (scan < 100) continue;
    out.mean_log[0] += std::log(unrest.density()[0] / kUnrest) / 300.0;
    out.mean_log[1] += std::log(unrest.density()[5] / kUnrest) / 300.0;
    out.rocking_rms += (prior.begin_mean.head<6>() - motion.pose()).head<2>().squaredNorm() / 600.0;
  }
  out.rocking_rms = std::sqrt(out.rocking_rms);
  return out;
}

TEST(Unrest, PullLeadsWhereTheSolutionGoes) {
  Motion motion(1);
  Prior prior;
  prior.begin_information = 1e4 * KnotInformation::Identity();
  prior.acceleration_density = six(0.02, 0.3, 0.1);
  const Equations data = looks_at(motion);
  const Solved solved = solve(prior, data);
  constexpr double kStep = 1e-4;
  for (int kind = 0; kind < kUnrests; ++kind) {
    const double up = std::exp(kStep);
    Prior more = prior;
    more.acceleration_density = kind == 0 ? six(0.02 * up, 0.3, 0.1) : six(0.02, 0.3 * up, 0.1);
    const Knot change = (solve(more, data).x - solved.x).tail<kKnotSize>() / kStep;
    EXPECT_GT(change.norm(), 1e-6);
    EXPECT_LT((solved.end_by_unrest.col(kind) - change.head<6>()).norm(),
              1e-3 * solved.end_by_unrest.col(kind).norm());
  }
}

// Where the noise is white and the motion as the prior has it, the errors are least where the prior
// is true.
TEST(Unrest, FindsThatOfTheMotion) {
  for (const double wrong : {0.04, 1.0, 5.0}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Followed followed =
          follow(Motion(seed), Vector6d::Constant(wrong * kUnrest), Belief::learnt);
      EXPECT_LT(followed.mean_log.cwiseAbs().maxCoeff(), std::log(2.5)) << "begun at " << wrong;
    }
  }
}

// What comes once a scan is no noise, and calm hides it from both sides alike.
TEST(Unrest, IsNotCalmedByWhatShakesOnceAScan) {
  for (const double hz : {8.0, 10.0, 12.0}) {
    const Motion motion(1, {.amplitude = 3e-3, .hz = hz});
    double least_rms = 1.0;
    for (const double ratio : {0.2, 1.0, 5.0, 25.0}) {
      const Vector6d constant = Vector6d::Constant(ratio * kUnrest);
      least_rms = std::min(least_rms, follow(motion, constant, Belief::constant).rocking_rms);
    }
    const Followed learnt = follow(motion, Vector6d::Constant(kUnrest), Belief::learnt);
    EXPECT_LT(learnt.rocking_rms, 1.1 * least_rms) << hz << " Hz";
  }
}

TEST(Unrest, LearnsEachKindAloneAndStaysInBounds) {
  const Vector6d usual = six(0.3, 3.0, 0.03);
  EndByUnrest by_unrest = EndByUnrest::Zero();
  by_unrest.col(0) << 1e-3, -1e-3, 0.0, 0.0, 0.0, 0.01;
  by_unrest.col(1) << 1e-3, 0.0, 0.0, 0.0, 0.01, 0.0;  // the height does not follow
  Unrest unrest(usual);
  unrest.learn(six(0.0, 0.0, 0.01), by_unrest, PerUnrest::Zero());
  EXPECT_EQ(unrest.density(), usual);
  Vector6d correction = six(0.0, 0.02, 0.01);
  correction[0] = 1e-4;
  correction[1] = -1e-4;
  for (int scan = 0; scan < 200; ++scan) unrest.learn(correction, by_unrest, PerUnrest::Zero());
  EXPECT_NEAR(std::log(unrest.density()[0] / usual[0]), 4.0, 1e-9);
  EXPECT_EQ(unrest.density()[1], unrest.density()[0]);
  EXPECT_EQ(unrest.density().tail<4>(), usual.tail<4>());
  for (int scan = 0; scan < 200; ++scan) unrest.learn(-correction, by_unrest, PerUnrest::Zero());
  EXPECT_NEAR(std::log(unrest.density()[0] / usual[0]), -2.0, 1e-9);
}

TEST(Unrest, ASurpriseIsBelievedAtOnce) {
  Prior prior;
  prior.acceleration_density = six(0.3, 3.0, 0.03);
  // A constant acceleration a over dt departs by a dt^2/2 and a dt: a^2 dt / q, over two numbers.
  const double a = 20.0, dt_s = kSpan_s / kSegments;
  Unknowns x = Unknowns::Zero(kSize);
  for (int k = 1; k <= kSegments; ++k) {
    const double t_s = k * dt_s;
    x[kKnotSize * k + 5] = 0.5 * a * t_s * t_s;
    x[kKnotSize * k + 11] = a * t_s;
  }
  const PerUnrest surprise = surprise_of(prior, kSegments, x);
  EXPECT_EQ(surprise[0], 0.0);
  EXPECT_NEAR(surprise[1], a * a * dt_s / 3.0 / 2.0, 1e-9);
  const Prior loose = loosened(prior, surprise);
  EXPECT_EQ(loose.acceleration_density.head<5>(), prior.acceleration_density.head<5>());
  EXPECT_NEAR(surprise_of(loose, kSegments, x)[1], 1.0, 1e-9);
  Unrest unrest(prior.acceleration_density);
  unrest.learn(Vector6d::Zero(), EndByUnrest::Zero(), surprise);
  EXPECT_NEAR(unrest.density()[5], loose.acceleration_density[5], 1e-9);
}

}  // namespace
}  // namespace lilo::standard
