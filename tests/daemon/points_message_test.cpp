// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/points_message.hpp"

#include "tests/daemon/schema.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <random>
#include <string>
#include <vector>

namespace lilo {
namespace {

using nlohmann::json;

const PointsContext kContext{"0123456789abcdef", 1'453'364'282'709'000'001, 4'294'967'295};

/// RFC 4648, bit by bit.
std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  unsigned bits = 0, held = 0;
  for (const char c : text) {
    held = held << 6U | static_cast<unsigned>(alphabet.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<std::uint8_t>(held >> bits & 0xFFU));
  }
  return bytes;
}

std::vector<Eigen::Vector3d> points_of(const json& points) {
  const std::vector<std::uint8_t> bytes = from_base64(points["xyz"]);
  const double step_m = points["resolution_m"];
  std::vector<Eigen::Vector3d> out;
  for (std::size_t k = 0; k + 6 <= bytes.size(); k += 6) {
    const auto axis = [&](std::size_t at) {
      return step_m * static_cast<std::int16_t>(bytes[k + at] | bytes[k + at + 1] << 8U);
    };
    out.emplace_back(axis(0), axis(2), axis(4));
  }
  return out;
}

std::vector<Eigen::Vector3f> random_points(std::size_t count) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> metres(-327.0F, 327.0F);
  std::vector<Eigen::Vector3f> out(count);
  for (Eigen::Vector3f& p : out) p = {metres(rng), metres(rng), metres(rng)};
  return out;
}

TEST(PointsMessage, TellsEveryPointToACentimetre) {
  const std::vector<Eigen::Vector3f> sent = random_points(601);
  const json schema = protocol_schema();
  JsonWriter out;
  std::vector<Eigen::Vector3d> got;
  ASSERT_EQ(points_datagrams(sent.size()), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    const std::string_view datagram = write_points(kContext, PointSet::scan, sent, k, out);
    ASSERT_FALSE(datagram.empty());
    ASSERT_LE(datagram.size(), 1200U);
    const json message = json::parse(datagram);
    EXPECT_EQ(violations(schema, message), std::vector<std::string>{});
    EXPECT_EQ(message["seq"], 4'294'967'295);
    EXPECT_EQ(message["points"]["of"], "scan");
    EXPECT_EQ(message["points"]["index"], k);
    EXPECT_EQ(message["points"]["count"], 6);
    for (const Eigen::Vector3d& p : points_of(message["points"])) got.push_back(p);
  }
  ASSERT_EQ(got.size(), sent.size());
  for (std::size_t k = 0; k < got.size(); ++k)
    EXPECT_LT((got[k] - sent[k].cast<double>()).cwiseAbs().maxCoeff(), 0.0051);
}

// A number that 16 bits cannot hold, or that is none, would come out as another place.
TEST(PointsMessage, LeavesOutWhatItCannotSay) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> sent{
      {1.0F, 2.0F, 3.0F}, {400.0F, 0.0F, 0.0F}, {0.0F, kNan, 0.0F}, {0.0F, 0.0F, -1e30F}};
  JsonWriter out;
  const json message = json::parse(write_points(kContext, PointSet::map, sent, 0, out));
  const std::vector<Eigen::Vector3d> got = points_of(message["points"]);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_LT((got[0] - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-9);
  EXPECT_EQ(message["points"]["of"], "map");
}

TEST(PointsMessage, NoPointsAreNoDatagrams) { EXPECT_EQ(points_datagrams(0), 0U); }

}  // namespace
}  // namespace lilo
