#include "command_line.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <string_view>

#include <CLI/CLI.hpp>

#include "kadans/signal/nearest_name.h"

namespace kadans::football {
namespace {

constexpr int exit_usage = 2;

// Digits only: CLI11's own check reads -1 as 18446744073709551615.
CLI::Validator whole_within(std::uint64_t min, std::uint64_t max) {
  const auto check = [=](const std::string& value) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error == std::errc{} && end == value.data() + value.size() && number >= min && number <= max)
      return std::string();
    return "a whole number from " + std::to_string(min) + " to " + std::to_string(max) + " is wanted, not '" + value +
           "'";
  };
  return {check, ""};
}

CLI::App* add_command(CLI::App& app, Options& o, Options::Command command, const char* name, const char* doc) {
  CLI::App* added = app.add_subcommand(name, doc);
  added->callback([&o, command] { o.command = command; });
  added->add_flag("--json", o.json, "Print one JSON object");
  return added;
}

void add_play(CLI::App& command, Options& o) {
  command
      .add_option("--seed", o.seed,
                  "Seed of all random numbers (default: the file's); of many matches the first one's (default: 1)")
      ->type_name("N")
      ->check(whole_within(0, 9'007'199'254'740'992));
  command.add_option("--set", o.set, "In place of what the file says: network.lost=0.3, home.team=behaviors/football")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command.add_flag("-v,--verbose", o.verbose,
                   "Tell on stderr what is decided and said while it goes on; of many matches each");
}

// Of one match.
void add_file(CLI::App& command, Options& o) {
  command.add_option("file", o.files, "A match, such as config/matches/striker_drill.json")
      ->required()
      ->expected(1)
      ->type_name("FILE");
}

void add_match(CLI::App& app, Options& o) {
  CLI::App& match = *add_command(app, o, Options::Command::match, "match", "Play one match");
  add_file(match, o);
  add_play(match, o);
  match
      .add_option("--report", o.report,
                  "Write there the result (.json), all that was said (.txt) and where all were (.csv)")
      ->type_name("FOLDER");
  CLI::Option* const record =
      match.add_option("--record", o.record, "Write a record (.mcap), for kadans view, render and log")
          ->type_name("FILE");
  match
      .add_option("--signals", o.signals,
                  "Record these signals: \"joint.*, base.*@100\" (default: what shows the match)")
      ->type_name("PATTERNS")
      ->needs(record);
  match
      .add_flag("--live{8765}", o.live,
                "Show the match while it goes on, at the pace of the clock (default port: 8765)")
      ->type_name("PORT")
      ->check(whole_within(0, 65'535));
}

void add_matches(CLI::App& app, Options& o) {
  CLI::App& matches = *add_command(app, o, Options::Command::matches, "matches", "Play many matches, and tell of all");
  matches.add_option("files", o.files, "Matches")->required()->type_name("FILE");
  add_play(matches, o);
  matches
      .add_option("--cases", o.cases,
                  "So many matches of each file and each mix of --vary (default: 20), with seeds one after the other")
      ->type_name("N")
      ->check(whole_within(1, 100'000));
  matches.add_option("--vary", o.vary, "With each of these values")
      ->type_name("KEY=VALUE,VALUE,...")
      ->expected(1)
      ->take_all();
  matches.add_option("--jobs", o.jobs, "Matches at the same time (default: one a core)")
      ->type_name("N")
      ->check(whole_within(1, 1024));
  matches.add_option("--shard", o.shard, "Play only this part, 0/4 for example (default: that of the Slurm array)")
      ->type_name("PART/PARTS");
  matches
      .add_option("--out", o.out,
                  "Keep the results there; a match that has one is not played again; merge tells of them")
      ->type_name("FOLDER");
}

void add_serve(CLI::App& app, Options& o) {
  CLI::App& serve = *add_command(app, o, Options::Command::serve, "serve",
                                 "Serve a match in real time, each robot to a kadans run of its own");
  add_file(serve, o);
  add_play(serve, o);
  serve.add_option("--listen", o.listen, "Serve the first robot there, the next ones on the ports after it")
      ->required()
      ->type_name("HOST:PORT");
  serve
      .add_option("--robots", o.robots,
                  "Write the configurations of the robots there, in the project, and tell the commands that run them")
      ->type_name("FOLDER");
  serve.add_option("--referee", o.referee, "A game controller at this address is the referee, not the program's own")
      ->type_name("ADDRESS");
}

// What was meant by "mach" or "--sed"; "" when CLI11 says it well.
std::string meant(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string name = argv[1];
  if (std::ranges::find(names, name) == names.end())
    return "unknown command '" + name + "'" + did_you_mean(name, names);
  names.clear();
  for (const CLI::Option* option : app.get_subcommand(name)->get_options()) {
    for (const std::string& long_name : option->get_lnames()) names.push_back("--" + long_name);
  }
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i], option = word.substr(0, word.find('='));
    if (option.starts_with("--") && option != "--" && std::ranges::find(names, option) == names.end())
      return name + " has no option '" + option + "'" + did_you_mean(option, names);
  }
  return {};
}

}  // namespace

std::optional<int> read_options(int argc, char** argv, Options& options) {
  CLI::App app("Matches of robots that play football, in simulation.", "kadans-football");
  app.require_subcommand(1);
  add_match(app, options);
  add_matches(app, options);
  add_command(app, options, Options::Command::merge, "merge", "Tell of the results in folders of matches --out")
      ->add_option("folders", options.files, "Folders")
      ->required()
      ->type_name("FOLDER");
  add_serve(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    const std::string hint = meant(app, argc, argv);
    std::fprintf(stderr, "error: %s\nRun 'kadans-football --help' or 'kadans-football COMMAND --help'.\n",
                 hint.empty() ? error.what() : hint.c_str());
    return exit_usage;
  }
  return std::nullopt;
}

}  // namespace kadans::football
