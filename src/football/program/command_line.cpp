#include "command_line.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <string_view>

#include "kadans/signal/nearest_name.h"

namespace kadans::football {

const char* const usage =
    "usage: kadans-football match FILE [--seed N] [--set KEY=VALUE]... [--json] [--report FOLDER] [--record FILE]\n"
    "                                  [--signals PATTERNS] [--live[=PORT]] [--verbose]\n"
    "       kadans-football matches FILE... [--cases N] [--seed N] [--set KEY=VALUE]... [--vary "
    "KEY=VALUE,VALUE,...]...\n"
    "                                  [--jobs N] [--shard PART/PARTS] [--out FOLDER] [--json] [--verbose]\n"
    "       kadans-football merge FOLDER... [--json]\n"
    "       kadans-football serve FILE --listen HOST:PORT [--seed N] [--set KEY=VALUE]... [--robots FOLDER]\n"
    "                                  [--referee HOST] [--json] [--verbose]\n"
    "  FILE             a match, such as config/matches/striker_drill.json\n"
    "  --seed N         seed of all random numbers (default: the file's); of many matches the first one's (default: "
    "1)\n"
    "  --set KEY=VALUE  in place of what the file says: network.lost=0.3, home.team=behaviors/football\n"
    "  --json           print one JSON object\n"
    "  --report FOLDER  write there the result (.json), all that was said (.txt) and where all were (.csv)\n"
    "  --record FILE    write a record (.mcap), for kadans view, render and log\n"
    "  --signals X      record these signals: \"joint.*, base.*@100\" (default: what shows the match)\n"
    "  --live[=PORT]    show the match while it goes on (default: port 8765), at the pace of the clock\n"
    "  --verbose        tell on stderr what is decided and said while it goes on; of many matches each\n"
    "  --cases N        so many matches of each file and each mix of --vary (default: 20), with seeds one after the "
    "other\n"
    "  --vary KEY=A,B   with each of these values\n"
    "  --jobs N         matches at the same time (default: one a core)\n"
    "  --shard 0/4      play only this part (default: that of the Slurm array)\n"
    "  --out FOLDER     keep the results there; a match that has one is not played again; merge FOLDER tells of them\n"
    "  --listen X       serve the first robot there, the next ones on the ports after it, each to a kadans run\n"
    "  --robots FOLDER  write the configurations of the robots and the commands that run them\n"
    "  --referee HOST   a game controller there is the referee, not the program's own\n";

namespace {

using Command = Options::Command;

const std::array<std::string, 4> commands{"match", "matches", "merge", "serve"};

struct Option {
  std::string name, wants;  // "": it has no value
  std::vector<Command> commands;
  std::function<std::string(Options&, const std::string&)> take;
};

template <typename Field>
auto text(Field Options::*field) {
  return [field](Options& options, const std::string& value) {
    if constexpr (std::is_same_v<Field, std::string>)
      options.*field = value;
    else
      (options.*field).push_back(value);
    return std::string();
  };
}

auto whole(const char* name, std::optional<std::uint64_t> Options::*field, std::uint64_t min, std::uint64_t max) {
  return [name, field, min, max](Options& options, const std::string& value) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (value.empty() || error != std::errc{} || end != value.data() + value.size() || number < min || number > max)
      return std::string(name) + " needs a whole number from " + std::to_string(min) + " to " + std::to_string(max) +
             ", not '" + value + "'";
    options.*field = number;
    return std::string();
  };
}

auto flag(bool Options::*field) {
  return [field](Options& options, const std::string&) {
    options.*field = true;
    return std::string();
  };
}

const std::vector<Option>& all_options() {
  using enum Options::Command;
  static const std::vector<Option> all{
      {"--json", "", {match, matches, merge, serve}, flag(&Options::json)},
      {"--verbose", "", {match, matches, serve}, flag(&Options::verbose)},
      {"--seed", "a number", {match, matches, serve}, whole("--seed", &Options::seed, 0, 9'007'199'254'740'992)},
      {"--set", "KEY=VALUE", {match, matches, serve}, text(&Options::set)},
      {"--report", "a folder", {match}, text(&Options::report)},
      {"--record", "a file", {match}, text(&Options::record)},
      {"--signals", "patterns", {match}, text(&Options::signals)},
      {"--live", "", {match}, whole("--live", &Options::live, 0, 65'535)},
      {"--cases", "a number", {matches}, whole("--cases", &Options::cases, 1, 100'000)},
      {"--jobs", "a number", {matches}, whole("--jobs", &Options::jobs, 1, 1024)},
      {"--vary", "KEY=VALUE,VALUE", {matches}, text(&Options::vary)},
      {"--shard", "PART/PARTS", {matches}, text(&Options::shard)},
      {"--out", "a folder", {matches}, text(&Options::out)},
      {"--listen", "HOST:PORT", {serve}, text(&Options::listen)},
      {"--robots", "a folder", {serve}, text(&Options::robots)},
      {"--referee", "a host", {serve}, text(&Options::referee)},
  };
  return all;
}

std::string take_option(const std::string& word, Command command, int argc, char** argv, int& i, Options& options) {
  const std::size_t sign = word.find('=');
  const std::string name = word == "-v" ? "--verbose" : word.substr(0, sign);
  const auto found = std::ranges::find(all_options(), name, &Option::name);
  if (found == all_options().end()) {
    return "unknown option '" + name + "'" + did_you_mean(name, names_of(all_options()));
  }
  if (std::ranges::find(found->commands, command) == found->commands.end())
    return name + " is not for '" + commands.at(static_cast<std::size_t>(command)) + "'";
  if (name == "--live") return found->take(options, sign == std::string::npos ? "8765" : word.substr(sign + 1));
  if (found->wants.empty()) {
    if (sign != std::string::npos) return name + " has no value";
    return found->take(options, "");
  }
  if (sign != std::string::npos) return found->take(options, word.substr(sign + 1));
  if (i + 1 >= argc) return name + " needs " + found->wants;
  return found->take(options, argv[++i]);
}

std::string wrong_files(const Options& options) {
  if (options.command == Command::merge) return options.files.empty() ? "which folders of results?" : "";
  if (options.files.empty()) return "which match? It is a file";
  const bool one = options.command != Command::matches;
  if (one && options.files.size() > 1)
    return "one match at a time: '" + options.files[0] + "' and '" + options.files[1] + "'; or 'matches'";
  if (options.command == Command::serve && options.listen.size() != 1) return "serve needs --listen HOST:PORT, once";
  return "";
}

}  // namespace

std::string read_options(int argc, char** argv, Options& options) {
  if (argc < 2) return "what shall it do? 'match', 'matches', 'merge' or 'serve'";
  const auto found = std::ranges::find(commands, std::string_view(argv[1]));
  if (found == commands.end())
    return "unknown command '" + std::string(argv[1]) + "'" + did_you_mean(argv[1], commands);
  options.command = static_cast<Command>(found - commands.begin());
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.starts_with("-") || word == "-") {
      options.files.push_back(word);
      continue;
    }
    std::string wrong = take_option(word, options.command, argc, argv, i, options);
    if (!wrong.empty()) return wrong;
  }
  return wrong_files(options);
}

}  // namespace kadans::football
