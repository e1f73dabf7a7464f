// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lilo {

/// Draws a chart: writes `script` to `folder`/`name`.gp, where it can be changed and run again, and
/// runs gnuplot on it in that folder. Throws std::runtime_error, one line, when gnuplot is missing
/// or does not like the script.
void run_gnuplot(const std::string& folder, const std::string& name, const std::string& script);

/// The lines every chart begins with: a PNG of that size in pixels, CSV input, quiet axes on white.
std::string gnuplot_head(const std::string& png, int width, int height);

/// A string for gnuplot, in single quotes, where nothing is executed or replaced; a new line
/// becomes a space. Whether markup counts (enhanced) is the place's choice, not the string's.
std::string gnuplot_text(const std::string& text);

/// The name of a file in the script's folder, for gnuplot. One that begins with < or | is no
/// command.
std::string gnuplot_file(const std::string& name);

}  // namespace lilo
