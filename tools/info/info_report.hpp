// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/info/recording_info.hpp"

#include <string>

namespace lilo {

/// One screen for people: what is zero and not to be expected is left out, and of many losses the
/// largest are shown. `name` is the recording's.
std::string to_text(const std::string& name, const RecordingInfo& info);

/// Everything, for programs; the fields are always the same.
std::string to_json(const std::string& name, const RecordingInfo& info);

}  // namespace lilo
