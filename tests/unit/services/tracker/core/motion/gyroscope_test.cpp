// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "services/tracker/core/motion/gyroscope_prior.hpp"

namespace rds::tracker {
namespace {

constexpr std::int64_t kSampleNs = 5'000'000;  // 200 Hz
constexpr std::int64_t kFrameNs = 33'000'000;
constexpr double kNs = 1e-9;

/// Looks around: 1.2 rad/s at most, about axes that change.
Eigen::Vector3d rate_at(double s) {
  return {0.5 * std::sin(2 * s), 1.2 * std::cos(1.5 * s), 0.3 * std::sin(3 * s + 1)};
}

/// earlier_from_later of the true motion, in small steps.
Eigen::Quaterniond true_turn(std::int64_t from_ns, std::int64_t to_ns) {
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  constexpr std::int64_t kStepNs = 100'000;
  for (std::int64_t at = from_ns; at < to_ns; at += kStepNs) {
    const std::int64_t step = std::min(kStepNs, to_ns - at);
    turned = turned * turn_by(static_cast<double>(step) * kNs *
                              rate_at((static_cast<double>(at) + static_cast<double>(step) / 2) * kNs));
  }
  return turned;
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b);
}

GyroscopeBuffer buffer_of(std::int64_t end_ns) {
  GyroscopeBuffer buffer;
  for (std::int64_t t = 0; t <= end_ns; t += kSampleNs) buffer.add(t, rate_at(static_cast<double>(t) * kNs));
  return buffer;
}

TEST(GyroscopeBuffer, TurnsAsTheBodyDoes) {
  const GyroscopeBuffer buffer = buffer_of(2'000'000'000);
  for (const auto& [from, to] : {std::pair<std::int64_t, std::int64_t>{0, 33'000'000},
                                 {101'000'000, 134'300'000},
                                 {7'000'001, 1'999'000'000}}) {
    const auto turn = buffer.turn(from, to);
    ASSERT_TRUE(turn);
    EXPECT_LT(angle_between(*turn, true_turn(from, to)), 1e-4) << from;
  }
  EXPECT_LT(angle_between(*buffer.turn(5'000'000, 5'000'000), Eigen::Quaterniond::Identity()), 1e-12);
}

TEST(GyroscopeBuffer, SaysNothingOfTimesThatItDoesNotKnow) {
  GyroscopeBuffer buffer = buffer_of(1'000'000'000);
  EXPECT_FALSE(GyroscopeBuffer().turn(0, 1));
  EXPECT_FALSE(buffer.turn(-1, 500'000'000)) << "before the first";
  EXPECT_TRUE(buffer.turn(900'000'000, 1'015'000'000)) << "a little ahead";
  EXPECT_FALSE(buffer.turn(900'000'000, 1'030'000'000));
  EXPECT_FALSE(buffer.turn(500'000'000, 400'000'000));
  buffer.add(1'200'000'000, {0, 0, 0});
  EXPECT_FALSE(buffer.turn(900'000'000, 1'100'000'000)) << "a gap";
  buffer.add(1'205'000'000, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  buffer.add(1'100'000'000, {100, 0, 0});
  EXPECT_LT(angle_between(*buffer.turn(1'200'000'000, 1'210'000'000), Eigen::Quaterniond::Identity()), 1e-9)
      << "late ones, and what is no number, are dropped";
  buffer.add(0, {1, 0, 0});
  EXPECT_FALSE(buffer.turn(900'000'000, 950'000'000)) << "stamps went back";
}

/// The tracker's frames: vision is right to 2 mrad.
struct Watched {
  int frames_trusted = 0;
  double largest_error_rad = 0;
};
Watched watch(GyroscopePrior& prior, int first, int end) {
  Watched watched;
  for (int i = first; i < end; ++i) {
    const std::int64_t from = (i - 1) * kFrameNs, to = i * kFrameNs;
    const Eigen::Quaterniond truth = true_turn(from, to);
    if (const auto told = prior.expect(from, to)) {
      ++watched.frames_trusted;
      watched.largest_error_rad = std::max(watched.largest_error_rad, angle_between(*told, truth));
    }
    prior.observe(truth * turn_by(0.002 * Eigen::Vector3d(std::sin(i), std::cos(3 * i), std::sin(7 * i))));
  }
  return watched;
}

const Eigen::Vector3d kBias(0.02, -0.015, 0.01);

std::optional<Eigen::Quaterniond> biased(std::int64_t from_ns, std::int64_t to_ns) {
  return true_turn(from_ns, to_ns) * turn_by(static_cast<double>(to_ns - from_ns) * kNs * kBias);
}

TEST(GyroscopePrior, LearnsTheBiasAndTellsTheTurn) {
  GyroscopePrior prior(biased);
  EXPECT_EQ(watch(prior, 1, 20).frames_trusted, 0) << "vision has to find it right first";
  watch(prior, 20, 300);
  EXPECT_TRUE(prior.is_trusted());
  EXPECT_LT((prior.bias() - kBias).norm(), 0.004) << prior.bias().transpose();
  const Watched later = watch(prior, 300, 400);
  EXPECT_EQ(later.frames_trusted, 100);
  EXPECT_LT(later.largest_error_rad, 0.0005);
  EXPECT_EQ(prior.refused(), 0U);
  EXPECT_GE(prior.told(), 100U);
}

TEST(GyroscopePrior, OfAnotherClockOrMountingOrThatIsStuckIsNotTrusted) {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const std::vector<std::pair<const char*, Gyroscope>> wrong{
      {"stuck", [](auto, auto) { return std::optional(Eigen::Quaterniond::Identity()); }},
      {"late",
       [](std::int64_t from, std::int64_t to) {
         return std::optional(true_turn(from - 300'000'000, to - 300'000'000));
       }},
      {"mounted otherwise",
       [=](std::int64_t from, std::int64_t to) {
         return std::optional<Eigen::Quaterniond>(turned * true_turn(from, to) * turned.conjugate());
       }},
      {"the other way",
       [](std::int64_t from, std::int64_t to) {
         return std::optional<Eigen::Quaterniond>(true_turn(from, to).conjugate());
       }},
      {"in degrees", [](std::int64_t from, std::int64_t to) {
         return std::optional(turn_by(5 * rotation_of(true_turn(from, to))));
       }}};
  for (const auto& [name, gyroscope] : wrong) {
    GyroscopePrior prior(gyroscope);
    EXPECT_LT(watch(prior, 1, 600).frames_trusted, 20) << name;
    EXPECT_GT(prior.refused(), 20U) << name;
  }
}

TEST(GyroscopePrior, ThatGoesWrongIsNoLongerTrustedAndThatHealsIsAgain) {
  bool is_stuck = false;
  GyroscopePrior prior([&](std::int64_t from, std::int64_t to) {
    return is_stuck ? std::optional(Eigen::Quaterniond::Identity()) : biased(from, to);
  });
  watch(prior, 1, 200);
  ASSERT_TRUE(prior.is_trusted());
  is_stuck = true;
  EXPECT_LT(watch(prior, 200, 400).frames_trusted, 20);
  EXPECT_FALSE(prior.is_trusted());
  is_stuck = false;
  watch(prior, 400, 600);
  EXPECT_TRUE(prior.is_trusted());
}

TEST(GyroscopePrior, SaysNothingWithoutMeasurements) {
  GyroscopePrior none({});
  EXPECT_EQ(watch(none, 1, 100).frames_trusted, 0);
  GyroscopePrior silent([](auto, auto) { return std::optional<Eigen::Quaterniond>(); });
  EXPECT_EQ(watch(silent, 1, 100).frames_trusted, 0);
}

}  // namespace
}  // namespace rds::tracker
