// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lilo {

/// What the journal tells by a MESSAGE_ID of its own (journalctl MESSAGE_ID=...). For each,
/// systemd/lilod.catalog says what it means and what helps (journalctl -x).
enum class Event : std::uint8_t {
  started,
  stopping,
  sensor_found,
  sensor_refused,
  second_sensor,
  sensor_silent,
  sensor_back,
  no_scans,
  no_poses,
  tracking,
  relocalized,
  degraded,
  lost,
  session_replaced,
  session_reset,
  calibration_waiting,
  calibration_read,
  calibration_stored,
  calibration_not_stored,
  sensor_levelled,
  beams_resumed,
  beams_file_failed,
  client_refused,
  saved,
  not_saved,
  clock_set,
  faults,
  realtime_refused,
  config_taken,
  config_refused,
};
inline constexpr std::size_t kEventCount = 30;

/// As syslog(3) numbers them.
enum class Severity : std::uint8_t { error = 3, warning = 4, info = 6 };

struct EventDescription {
  std::string_view message_id;
  Severity severity;
};

constexpr EventDescription describe(Event event) {
  constexpr std::array<EventDescription, kEventCount> kEvents{{
      {"b17f291ebc0143ef96edc08169b227bf", Severity::info},     // started
      {"c920682322594d5781f1e682930e6d45", Severity::info},     // stopping
      {"8a3517d86967422b8e6654818d28d6db", Severity::info},     // sensor_found
      {"a2aa228745354bce9e757f4fff4684e8", Severity::warning},  // sensor_refused
      {"9f3693797025463b917630a2c72e5683", Severity::warning},  // second_sensor
      {"0ffde14048f24098b2f8dff0ec037987", Severity::warning},  // sensor_silent
      {"a1bf7b1f475c469682a6a1771f9413b1", Severity::info},     // sensor_back
      {"1a7f4da7d884460aa441e64e592f6ce1", Severity::warning},  // no_scans
      {"d5cad30bbbd44e8ba605c88078082490", Severity::warning},  // no_poses
      {"3eaccb1caa684f18af6b283c1c6c65bf", Severity::info},     // tracking
      {"c73231815b954d27bfe6496c9decea8e", Severity::info},     // relocalized
      {"c020ba0cefd14dcd8874003a76e50508", Severity::warning},  // degraded
      {"d65de15b36de4e7c8640cafd4e2813bf", Severity::warning},  // lost
      {"7c69e4a6c09049e69d3727cb569709fb", Severity::warning},  // session_replaced
      {"bb7d1aa70eb941dbaf3376ef3b3de2c1", Severity::info},     // session_reset
      {"7ef24143964f4db88bad631a26c328ec", Severity::info},     // calibration_waiting
      {"2fc53a9ad5e645adab6448bf6d37d2db", Severity::info},     // calibration_read
      {"34e8043eec1c4cd6ab32db8a8913d1d8", Severity::info},     // calibration_stored
      {"246a966f7fea4292a6f9641cf1a97c69", Severity::warning},  // calibration_not_stored
      {"b6c2ca53cd9b444890d32a00171e085b", Severity::info},     // sensor_levelled
      {"73abed68f8fe4bbcb013ce7eabb89b8e", Severity::info},     // beams_resumed
      {"673f0769078b4e7b87a26fb6dab9a00f", Severity::warning},  // beams_file_failed
      {"9c915a99f8ab4c80ab1ddd9243fd7549", Severity::warning},  // client_refused
      {"2a2929dfbc0244de8632edfcebaf244f", Severity::info},     // saved
      {"6e404e3473824d8ab8fd5459dc69409a", Severity::warning},  // not_saved
      {"299b16f953494e9c9829b264de7bd80b", Severity::warning},  // clock_set
      {"1e7925754d7e4e9498770a741c06b07d", Severity::warning},  // faults
      {"54d857dc7e7843f893c32b98dd666e12", Severity::warning},  // realtime_refused
      {"9d6af8d7395345638ec0ec9d3323a9f1", Severity::info},     // config_taken
      {"e9255f79e7f9424f8f33e6b258601857", Severity::error},    // config_refused
  }};
  return kEvents[static_cast<std::size_t>(event)];
}

}  // namespace lilo
