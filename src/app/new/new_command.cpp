#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/terminal.h"
#include "kadans/signal/output_file.h"
#include "kadans/signal/shell_word.h"
#include "new_files.h"
#include "realtime/machine/child_process.h"
#include "signal/input_file.h"

namespace kadans {

namespace fs = std::filesystem;

void write_new_files(const std::vector<fs::path>& fresh, const std::vector<NewFile>& files) {
  std::error_code error;
  for (const fs::path& path : fresh) {
    if (fs::exists(path, error)) refuse(path, "is there already; nothing is overwritten");
  }
  for (const NewFile& file : files) {
    write_output_file(file.path, file.text);
    std::printf("%s\n", file.path.c_str());
  }
  std::fflush(stdout);
}

void refuse_bad_name(const std::string& name, const std::string& what, const std::string& example) {
  constexpr std::size_t name_max = 48;
  const bool good =
      !name.empty() && name.size() <= name_max && name.back() != '_' && name.find("__") == std::string::npos &&
      name[0] >= 'a' && name[0] <= 'z' &&
      std::ranges::all_of(name, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
  if (good) return;
  refuse("'" + name + "': the name of " + what + " is words of a-z and 0-9 joined by _, at most " +
         std::to_string(name_max) + " letters, for example " + example);
}

std::string source_text(std::string_view text) {
  std::string literal = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') literal += '\\';
    if (static_cast<unsigned char>(c) >= ' ') literal += c;
  }
  return literal + "\"";
}

std::string filled_template(std::string_view text, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string result;
  while (!text.empty()) {
    const auto found = std::ranges::find_if(values, [&](const auto& value) { return text.starts_with(value.first); });
    if (found != values.end()) {
      result += found->second;
      text.remove_prefix(found->first.size());
    } else {
      result += text.front();
      text.remove_prefix(1);
    }
  }
  return result;
}

void tell_build(const fs::path& folder, const std::string& name) {
  std::fprintf(stderr, "Build and test it:  cd %s && cmake -B build && cmake --build build && build/%s_test\n",
               shell_word(folder.string()).c_str(), name.c_str());
}

void tell_command(const std::string& what, const fs::path& project, const std::string& arguments) {
  const fs::path there = fs::proximate(project);
  const std::string at = there == "." ? "" : "cd " + shell_word(there.string()) + " && ";
  std::fprintf(stderr, "%s:  %skadans %s\n", what.c_str(), at.c_str(), arguments.c_str());
}

int run_kadans(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "kadans");
  ChildProcess run({.words = std::move(arguments), .program = fs::read_symlink("/proc/self/exe").string()});
  run.wait();
  return run.exit_code() < 0 ? exit_failed : run.exit_code();
}

void add_new(CommandLine& line) {
  CLI::App* made = line.app.add_subcommand("new", "Write the first version of a new part of your project");
  made->require_subcommand(1);
  for (void (*const put)(CLI::App&, CommandLine&) :
       {add_new_robot, add_new_behavior, add_new_scenario, add_new_sweep, add_new_control_object, add_new_plant})
    put(*made, line);
}

}  // namespace kadans
