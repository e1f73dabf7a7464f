#include "tools/eval/eval_command.hpp"

namespace lilo {

void add_eval_command(CLI::App& app) {
  app.add_subcommand("eval", "Compare an estimated trajectory with the truth");
}

}  // namespace lilo
