// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace lilo {

/// The stages of the pipeline, to be timed.
enum class Stage : std::uint8_t { project, filter, reconstruct, deskew, align, update_map };
inline constexpr int kStageCount = 6;
const char* to_string(Stage stage);

/// Called when a stage of one scan has ended. core has no clock: the caller brings one.
struct StageHook {
  void (*done)(void* context, Stage stage) = nullptr;
  void* context = nullptr;
  void operator()(Stage stage) const {
    if (done != nullptr) done(context, stage);
  }
};

}  // namespace lilo
