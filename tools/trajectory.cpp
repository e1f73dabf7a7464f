// SPDX-License-Identifier: BSD-3-Clause
#include "tools/trajectory.hpp"

#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace lilo {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;
constexpr double kRotationTolerance = 1e-3;  // files with six digits stay well below this
constexpr std::int64_t kSecond = 1'000'000'000;

std::vector<std::string_view> split(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  std::vector<std::string_view> words;
  std::size_t at = line.find_first_not_of(kBlank);
  while (at != std::string_view::npos) {
    const std::size_t end = line.find_first_of(kBlank, at);
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlank, end);
  }
  return words;
}

/// Where a line stands, for messages.
struct Line {
  const std::string& file;
  int number;
  std::vector<std::string_view> words;

  [[nodiscard]] std::runtime_error error(const std::string& what) const {
    return std::runtime_error(fmt::format("{}:{}: {}", file, number, what));
  }

  [[nodiscard]] double number_at(std::size_t column) const {
    const std::string_view word = words[column];
    double value = 0.0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (status != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) {
      throw error(fmt::format("expected a number in column {}, found '{}'", column + 1, word));
    }
    return value;
  }
};

/// Decimal seconds to nanoseconds without the 0.2 us a double loses at today's UTC.
std::optional<std::int64_t> exact_ns(std::string_view word) {
  const std::size_t point = word.find('.');
  const std::string_view whole = word.substr(0, point);
  std::string decimals(point == std::string_view::npos ? "" : word.substr(point + 1));
  decimals.resize(9, '0');  // digits below a nanosecond are cut
  std::int64_t seconds = 0, ns = 0;
  const auto a = std::from_chars(whole.data(), whole.data() + whole.size(), seconds);
  const auto b = std::from_chars(decimals.data(), decimals.data() + decimals.size(), ns);
  const bool digits_only = a.ec == std::errc{} && a.ptr == whole.data() + whole.size() &&
                           b.ec == std::errc{} && b.ptr == decimals.data() + decimals.size();
  if (!digits_only || ns < 0 || std::abs(seconds) > INT64_MAX / kSecond - 1) return std::nullopt;
  return seconds * kSecond + (whole.starts_with('-') ? -ns : ns);
}

StampedPose parse_tum(const Line& line) {
  StampedPose result;
  const double seconds = line.number_at(0);
  if (std::abs(seconds) > 9e9) throw line.error("expected seconds in column 1");
  result.stamp_ns =
      exact_ns(line.words[0]).value_or(static_cast<std::int64_t>(std::llround(seconds * 1e9)));
  result.pose.translation_m = {line.number_at(1), line.number_at(2), line.number_at(3)};
  const Eigen::Quaterniond q(line.number_at(7), line.number_at(4), line.number_at(5),
                             line.number_at(6));
  if (std::abs(q.norm() - 1.0) > kRotationTolerance) {
    throw line.error(fmt::format("expected a unit quaternion, found one of norm {:.6g}", q.norm()));
  }
  result.pose.rotation = q.normalized();
  return result;
}

StampedPose parse_kitti(const Line& line, std::int64_t row) {
  Eigen::Matrix<double, 3, 4> m;
  for (Eigen::Index k = 0; k < 12; ++k) {
    m(k / 4, k % 4) = line.number_at(static_cast<std::size_t>(k));
  }
  const Eigen::Matrix3d r = m.leftCols<3>();
  const double skewness = (r * r.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (skewness > kRotationTolerance || r.determinant() < 0.0) {
    throw line.error("expected a rotation matrix in columns 1-3, 5-7, 9-11");
  }
  return {row, {Eigen::Quaterniond(r).normalized(), m.col(3)}};
}

void append(Trajectory& trajectory, const Line& line) {
  const std::size_t columns = line.words.size();
  const bool first = trajectory.poses.empty();
  if (first) trajectory.has_times = columns == kTumColumns;
  const std::size_t expected = trajectory.has_times ? kTumColumns : kKittiColumns;
  if (columns != expected) {
    throw line.error(fmt::format("expected {} numbers, found {}",
                                 first ? "8 (TUM) or 12 (KITTI)" : fmt::format("{}", expected),
                                 columns));
  }
  const auto row = static_cast<std::int64_t>(trajectory.poses.size());
  const StampedPose pose = trajectory.has_times ? parse_tum(line) : parse_kitti(line, row);
  if (!first && pose.stamp_ns <= trajectory.poses.back().stamp_ns) {
    throw line.error("expected a later time than in the line before");
  }
  trajectory.poses.push_back(pose);
}

}  // namespace

Trajectory read_trajectory(const std::string& path) {
  std::ifstream file = open_text(path);
  Trajectory trajectory{.name = path};
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    Line line{path, number, split(text)};
    if (!line.words.empty() && !line.words[0].starts_with('#')) append(trajectory, line);
  }
  if (trajectory.poses.empty()) {
    throw std::runtime_error(fmt::format("{}: expected TUM or KITTI poses, found none", path));
  }
  return trajectory;
}

std::string tum_line(const StampedPose& stamped) {
  const Eigen::Vector3d& t = stamped.pose.translation_m;
  const Eigen::Quaterniond& q = stamped.pose.rotation;
  return fmt::format("{}{}.{:09d} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}",
                     stamped.stamp_ns < 0 ? "-" : "", std::abs(stamped.stamp_ns / kSecond),
                     std::abs(stamped.stamp_ns % kSecond), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(),
                     q.w());
}

void write_tum(const std::string& path, const std::vector<StampedPose>& poses) {
  std::ofstream file = create_text(path);
  for (const StampedPose& pose : poses) file << tum_line(pose) << '\n';
  finish_text(file, path);
}

void write_kitti(const std::string& path, const std::vector<StampedPose>& poses) {
  std::ofstream file = create_text(path);
  for (const StampedPose& stamped : poses) {
    const Eigen::Matrix3d r = stamped.pose.rotation.toRotationMatrix();
    const Eigen::Vector3d& t = stamped.pose.translation_m;
    for (Eigen::Index row = 0; row < 3; ++row) {
      file << fmt::format("{}{:.12e} {:.12e} {:.12e} {:.12e}", row == 0 ? "" : " ", r(row, 0),
                          r(row, 1), r(row, 2), t[row]);
    }
    file << '\n';
  }
  finish_text(file, path);
}

std::vector<double> travelled_m(const std::vector<Pose>& poses) {
  std::vector<double> distance(poses.size(), 0.0);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    distance[k] = distance[k - 1] + (poses[k].translation_m - poses[k - 1].translation_m).norm();
  }
  return distance;
}

}  // namespace lilo
