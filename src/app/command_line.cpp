#include "command_line.h"

#include "commands.h"
#include "terminal.h"

namespace kadans {
namespace {

constexpr const char* about =
    "Kadans: a scriptable control runtime for robots.\n"
    "A 1 kHz core executes compiled control objects; behaviors in Lua tell them what to do.\n";

void add_commands(const CLI::App& app, const std::string& path, std::vector<CommandEntry>& all) {
  for (const CLI::App* command : visible_below(app)) {
    const std::string words = path + (path.empty() ? "" : " ") + command->get_name();
    if (!visible_below(*command).empty()) {
      add_commands(*command, words, all);
      continue;
    }
    CommandEntry entry{.words = words, .command = command, .options = {}};
    for (const CLI::App* at = command; at->get_parent() != nullptr; at = at->get_parent()) {
      if (at != command && !command->get_fallthrough()) break;
      for (const CLI::Option* option : at->get_options()) {
        if (option != at->get_help_ptr()) entry.options.push_back(option);
      }
    }
    all.push_back(std::move(entry));
  }
}

}  // namespace

std::vector<const CLI::App*> visible_below(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

CommandLine::CommandLine() : app(about, "kadans") {
  app.require_subcommand(1);
  for (void (*const put)(CommandLine&) : {add_sim,        add_test,   add_replay,     add_debug,
                                          add_check,      add_sweep,  add_merge,      add_margin,
                                          add_shrink,     add_tune,   add_behavior,   add_repl,
                                          add_stubs,      add_params, add_run,        add_behavior_process,
                                          add_plant,      add_jog,    add_commission, add_dynamixel,
                                          add_jitter,     add_ctl,    add_push,       add_receive,
                                          add_completion, add_view,   add_render,     add_log,
                                          add_doctor,     add_new,    add_reference})
    put(*this);
  add_examples(app);
}

int CommandLine::run(std::span<char*> arguments) {
  arguments_ = arguments;
  for (const auto& [command, does] : runs_) {
    if (command->parsed()) return does();
  }
  return exit_usage;
}

std::vector<CommandEntry> commands_of(const CommandLine& line) {
  std::vector<CommandEntry> all;
  add_commands(line.app, "", all);
  return all;
}

}  // namespace kadans
