// SPDX-License-Identifier: BSD-3-Clause
#include "tools/kitti_truth.hpp"

#include "drivers/kitti_times.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace lilo {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kScanPeriod_ns = 100'000'000;  // where there is no times.txt
constexpr double kEarthRadius_m = 6378137.0;

std::vector<double> numbers_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> numbers;
  for (double value; in >> value;) numbers.push_back(value);
  return numbers;
}

/// The numbers behind "key:", none where no line starts so.
std::optional<std::vector<double>> line_of(const std::string& file, const std::string& key) {
  std::ifstream in = open_text(file);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(key + ":")) return numbers_of(line.substr(key.size() + 1));
  }
  return std::nullopt;
}

/// `r` row by row.
Pose pose_of(const double* r, const Eigen::Vector3d& t) {
  const Eigen::Matrix3d rotation =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r);
  return {Eigen::Quaterniond(rotation).normalized(), t};
}

fs::path first_file(const std::vector<fs::path>& candidates) {
  for (const fs::path& file : candidates) {
    if (fs::is_regular_file(file)) return file;
  }
  throw std::runtime_error(
      fmt::format("{}: expected true poses there, found no such file", candidates[0].string()));
}

/// The lowest number among the scans NNNNNN.bin.
std::int64_t first_scan(const fs::path& folder) {
  std::optional<std::int64_t> first;
  for (const auto& item : fs::directory_iterator(folder)) {
    std::int64_t number = 0;
    const std::string stem = item.path().stem().string();
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    if (item.path().extension() != ".bin" || error != std::errc{}) continue;
    first = std::min(first.value_or(number), number);
  }
  return first.value_or(0);
}

void set_times(Trajectory& truth, const KittiTimes& times_ns, std::int64_t first) {
  truth.has_times = true;
  for (std::size_t k = 0; k < truth.poses.size(); ++k) {
    const std::optional<std::int64_t> time_ns = k < times_ns.size() ? times_ns[k] : std::nullopt;
    truth.poses[k].stamp_ns =
        time_ns.value_or((static_cast<std::int64_t>(k) - first) * kScanPeriod_ns);
  }
}

/// One file of oxts/data: latitude, longitude (deg), altitude (m), roll, pitch, yaw (rad), ...
Pose imu_pose(const std::string& file, double scale) {
  std::ifstream in = open_text(file);
  std::string line;
  std::getline(in, line);
  const std::vector<double> v = numbers_of(line);
  if (v.size() < 6) {
    throw std::runtime_error(
        fmt::format("{}:1: expected at least 6 numbers, found {}", file, v.size()));
  }
  constexpr double kPi = std::numbers::pi;
  const double x_m = scale * kEarthRadius_m * v[1] * kPi / 180.0;
  const double y_m = scale * kEarthRadius_m * std::log(std::tan((90.0 + v[0]) * kPi / 360.0));
  return {Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitX()),
          {x_m, y_m, v[2]}};
}

double mercator_scale(const std::string& file) {
  std::ifstream in = open_text(file);
  double latitude_deg = 0.0;
  in >> latitude_deg;
  return std::cos(latitude_deg * std::numbers::pi / 180.0);
}

}  // namespace

Pose kitti_calibration(const std::string& file, const std::string& key) {
  const auto whole = line_of(file, key);
  if (whole && whole->size() == 12) {
    const std::vector<double>& m = *whole;
    const std::vector<double> r = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    return pose_of(r.data(), {m[3], m[7], m[11]});
  }
  const auto rotation = line_of(file, "R"), translation = line_of(file, "T");
  if (!rotation || !translation || rotation->size() != 9 || translation->size() != 3) {
    throw std::runtime_error(
        fmt::format("{}: expected a line `{}: 12 numbers` or lines `R: 9` and `T: 3 numbers`, "
                    "found none",
                    file, key));
  }
  return pose_of(rotation->data(), Eigen::Vector3d(translation->data()));
}

Trajectory kitti_sequence_truth(const std::string& folder) {
  const fs::path root = fs::canonical(folder);
  const std::string number = root.filename().string() + ".txt";
  const fs::path file =
      first_file({root / "poses.txt", root.parent_path().parent_path() / "poses" / number});
  const Pose Tr = kitti_calibration((root / "calib.txt").string(), "Tr");
  Trajectory truth = read_trajectory(file.string());
  for (StampedPose& pose : truth.poses) pose.pose = Tr.inverse() * pose.pose * Tr;
  set_times(truth, read_kitti_times(root / "times.txt"), first_scan(root / "velodyne"));
  return truth;
}

Trajectory kitti_raw_truth(const std::string& folder) {
  const fs::path root = fs::canonical(folder);
  const fs::path calibration =
      first_file({root / "calib_imu_to_velo.txt", root.parent_path() / "calib_imu_to_velo.txt"});
  const Pose T_imu_sensor = kitti_calibration(calibration.string(), "Tr").inverse();
  std::vector<std::string> files;
  for (const auto& item : fs::directory_iterator(root / "oxts" / "data")) {
    if (item.path().extension() == ".txt") files.push_back(item.path().string());
  }
  if (files.empty()) throw std::runtime_error(folder + "/oxts/data: expected poses, found none");
  std::sort(files.begin(), files.end());
  const double scale = mercator_scale(files.front());
  Trajectory truth{.name = root.string() + "/oxts"};
  const Pose T_start_world = (imu_pose(files.front(), scale) * T_imu_sensor).inverse();
  for (const std::string& file : files) {
    truth.poses.push_back({0, T_start_world * imu_pose(file, scale) * T_imu_sensor});
  }
  // Without the scans' own times both are counted in steps.
  KittiTimes times_ns;
  if (fs::is_regular_file(root / "velodyne_points" / "timestamps.txt")) {
    times_ns = read_kitti_times(root / "oxts" / "timestamps.txt");
  }
  set_times(truth, times_ns, first_scan(root / "velodyne_points" / "data"));
  return truth;
}

}  // namespace lilo
