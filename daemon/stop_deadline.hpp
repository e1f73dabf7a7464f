// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lilo {

/// From now on the process has so many seconds to end by itself; then it ends without its threads,
/// with exit code 1 and a line on stderr, whatever they wait for: a scan that takes for ever, a
/// disk that does not answer.
void start_stop_deadline(unsigned seconds);

}  // namespace lilo
