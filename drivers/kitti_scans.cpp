// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/kitti_scans.hpp"

#include "drivers/kitti_rings.hpp"
#include "drivers/kitti_sweeps.hpp"
#include "drivers/kitti_times.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <vector>

namespace lilo {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kScanPeriodNs = 100'000'000;

struct Entry {
  fs::path file;
  std::uint64_t number;
};

// The scans of a folder, by number.
std::vector<Entry> list_scans(const fs::path& folder) {
  std::vector<Entry> entries;
  for (const auto& item : fs::directory_iterator(folder)) {
    if (item.path().extension() != ".bin") continue;
    const std::string stem = item.path().stem().string();
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    if (error == std::errc{} && end == stem.data() + stem.size())
      entries.push_back({item.path(), number});
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.number < b.number; });
  return entries;
}

// Where the scans of the folder a user names are. Of a raw drive also velodyne_points, else the
// file with their times.
struct Layout {
  fs::path scans, times, raw;
};

Layout layout_of(const fs::path& folder) {
  if (fs::is_directory(folder / "velodyne")) return {folder / "velodyne", folder / "times.txt", {}};
  const fs::path raw = folder / "velodyne_points";
  if (fs::is_directory(raw / "data")) return {raw / "data", {}, raw};
  for (const fs::path& file : {folder / "times.txt", folder / ".." / "times.txt"}) {
    if (fs::is_regular_file(file)) return {folder, file, {}};
  }
  const fs::path above = folder / "..";
  for (const char* name : {"timestamps.txt", "timestamps_start.txt", "timestamps_end.txt"}) {
    if (fs::is_regular_file(above / name)) return {folder, {}, above};
  }
  return {folder, {}, {}};
}

// Turns every ray up by `angle_rad` in its own vertical plane. IMLS-SLAM, CT-ICP and KISS-ICP do
// the same as a rotation about p x z.
void raise_rays(Returns& returns, BeamTable& beams, double angle_rad) {
  if (angle_rad == 0.0) return;
  const float c = static_cast<float>(std::cos(angle_rad));
  const float s = static_cast<float>(std::sin(angle_rad));
  for (Return& r : returns) {
    const float across_m = std::hypot(r.x_m, r.y_m);
    if (across_m == 0.0F) continue;  // straight up: its azimuth is unknown
    const float factor = c - s * r.z_m / across_m;
    r.z_m = c * r.z_m + s * across_m;
    r.x_m *= factor;
    r.y_m *= factor;
  }
  for (int ring = 0; ring < beams.ring_count; ++ring) {
    beams.elevation_rad[static_cast<std::size_t>(ring)] += static_cast<float>(angle_rad);
  }
}

Return to_return(const std::array<float, 4>& point) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const auto [x, y, z, intensity] = point;
  const float azimuth = std::atan2(y, x);
  return {.x_m = x,
          .y_m = y,
          .z_m = z,
          .azimuth_rad = azimuth < kPi ? azimuth : -kPi,
          .t_ns = static_cast<std::int32_t>(kScanPeriodNs),
          .ring = 0,
          .intensity =
              static_cast<std::uint8_t>(std::lround(std::clamp(intensity, 0.0F, 1.0F) * 255.0F)),
          .kind = ReturnKind::strongest};
}

class KittiScans final : public ScanSource {
 public:
  KittiScans(const fs::path& folder, const SensorConfig& config) : config_(config) {
    const Layout layout = layout_of(folder);
    scans_ = list_scans(layout.scans);
    if (scans_.empty())
      throw DriverError(folder.string() + ": expected scans named NNNNNN.bin, found none");
    if (layout.raw.empty()) {
      find_instants(read_kitti_times(layout.times));
      return;
    }
    std::vector<std::uint64_t> numbers;
    for (const Entry& entry : scans_) numbers.push_back(entry.number);
    sweeps_ = kitti_sweeps(layout.raw, numbers);
    as_measured_ = true;
  }

  bool next(Scan& scan) override {
    if (position_ == scans_.size()) return false;
    const Entry& entry = scans_[position_];
    const KittiSweep& sweep = sweeps_[position_];
    ++position_;
    scan.clear();
    scan.index = entry.number - scans_.front().number;
    scan.start_ns = sweep.start_ns;
    scan.end_ns = sweep.end_ns;
    scan.clock = ClockSource::replay;
    scan.motion_compensated = !as_measured_;
    scan.complete = read_points(entry.file, scan.returns);
    scan.coverage_rad = scan.complete ? 2.0F * std::numbers::pi_v<float> : 0.0F;
    recover_kitti_rings(scan.returns, scan.beams);
    raise_rays(scan.returns, scan.beams, config_.kitti_elevation_offset_rad);
    keep_in_range(scan.returns);
    if (as_measured_) time_kitti_returns(scan.returns, scan.end_ns - scan.start_ns);
    ++(scan.complete ? counts_.scans_complete : counts_.scans_partial);
    return true;
  }
  [[nodiscard]] DriverCounts driver_counts() const override { return counts_; }
  [[nodiscard]] SourceCounts source_counts() const override { return {}; }
  [[nodiscard]] double progress() const override {
    return static_cast<double>(position_) / static_cast<double>(scans_.size());
  }
  [[nodiscard]] std::string error() const override { return error_; }

 private:
  // The instant all points were moved to; the turn before it is of no use to anyone.
  void find_instants(const KittiTimes& times_ns) {
    for (const Entry& entry : scans_) {
      const std::optional<std::int64_t> time_ns =
          entry.number < times_ns.size() ? times_ns[entry.number] : std::nullopt;
      const auto steps = static_cast<std::int64_t>(entry.number - scans_.front().number);
      const std::int64_t end_ns = time_ns.value_or(steps * kScanPeriodNs);
      sweeps_.push_back({end_ns - kScanPeriodNs, end_ns});
    }
  }

  bool read_points(const fs::path& file, Returns& returns) {
    std::ifstream in(file, std::ios::binary);
    buffer_.resize(in ? fs::file_size(file) : 0);
    in.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    std::array<float, 4> point;
    if (buffer_.empty() || !in || buffer_.size() % sizeof(point) != 0) {
      error_ = file.string() + ": expected float32 x y z intensity per point, found " +
               std::to_string(buffer_.size()) + " bytes";
      return false;
    }
    for (std::size_t at = 0; at < buffer_.size(); at += sizeof(point)) {
      std::copy_n(buffer_.data() + at, sizeof(point), reinterpret_cast<char*>(point.data()));
      if (std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]))
        returns.push_back(to_return(point));
    }
    return true;
  }

  // After the rings: those are told by the order of all points.
  void keep_in_range(Returns& returns) const {
    const auto out_of_range = [this](const Return& r) {
      const auto range_m = static_cast<double>(std::hypot(r.x_m, r.y_m, r.z_m));
      return range_m < config_.min_range_m || range_m > config_.max_range_m;
    };
    std::erase_if(returns, out_of_range);
  }

  SensorConfig config_;
  std::vector<Entry> scans_;
  std::vector<KittiSweep> sweeps_;  // one a scan
  bool as_measured_ = false;        // else the points were moved to the sweep's end
  std::vector<char> buffer_;
  std::size_t position_ = 0;
  DriverCounts counts_;
  std::string error_;
};

}  // namespace

std::unique_ptr<ScanSource> open_kitti_scans(const std::string& folder,
                                             const SensorConfig& config) {
  return std::make_unique<KittiScans>(fs::path(folder), config);
}

}  // namespace lilo
