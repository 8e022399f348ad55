#include "command_line.h"

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
  add_sim(app, sim);
  add_test(app, test);
  add_replay(app, replay);
  add_debug(app, debug);
  add_check(app, check);
  add_sweep(app, sweep);
  add_merge(app, merge);
  add_margin(app, margin);
  add_shrink(app, shrink);
  add_tune(app, tune);
  add_behavior(app, behavior);
  add_repl(app, repl);
  add_stubs(app, stubs);
  add_params(app, params);
  add_run(app, run);
  add_behavior_process(app, behavior_process);
  add_plant(app, plant);
  add_jog(app, jog);
  add_commission(app, commission);
  add_dynamixel(app, dynamixel);
  add_jitter(app, jitter);
  add_ctl(app, ctl);
  add_push(app, push);
  add_receive(app, receive);
  add_completion(app, completion);
  add_view(app, view);
  add_render(app, render);
  add_log(app, log);
  add_doctor(app, doctor);
  add_new(app, made);
  add_reference(app, reference);
  add_examples(app);
}

std::vector<CommandEntry> commands_of(const CommandLine& line) {
  std::vector<CommandEntry> all;
  add_commands(line.app, "", all);
  return all;
}

}  // namespace kadans
