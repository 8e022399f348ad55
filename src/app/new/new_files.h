// What all commands of `kadans new` share: names, templates, files that overwrite nothing, and what they run at their
// end. None of it is fast or runs beside a loop.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/command_line.h"

namespace kadans {

struct NewFile {
  std::filesystem::path path;
  std::string text;
};
// Writes the files, with their folders, and says which. Throws InputError, and writes nothing, when one of `fresh` is
// there already.
void write_new_files(const std::vector<std::filesystem::path>& fresh, const std::vector<NewFile>& files);

// Throws InputError unless the name consists of words of a-z and 0-9 that begin with a letter and are joined by _.
// `what` is for the message: "a scenario".
void refuse_bad_name(const std::string& name, const std::string& what, const std::string& example);

std::string class_name_of(const std::string& name);  // "KneeDamper" of "knee_damper"

// A text as a literal of C or Lua, in double quotes; without control characters.
std::string source_text(std::string_view text);

// The text with each "@name@" replaced by what stands beside it.
std::string filled_template(std::string_view text, const std::vector<std::pair<std::string, std::string>>& values);

// "Build and test it: ..." of a folder with a CMakeLists.txt and the test NAME_test.
void tell_build(const std::filesystem::path& folder, const std::string& name);
// "Run it again: cd PROJECT && kadans ..." with what to type in a shell.
void tell_command(const std::string& what, const std::filesystem::path& project, const std::string& arguments);

// Runs this program with these arguments. Returns its exit code.
int run_kadans(std::vector<std::string> arguments);

struct NewControlObjectOptions {
  std::string name;
  std::string folder = ".";  // the object's folder is made in this folder
  bool plugin = false;
  std::string from_c;                // folder of C code that a tool has made; "": an example law
  std::optional<double> period_s{};  // of a step of that code
};
// A control object around C code that a tool has made; `main_template` is its main.cpp or plugin.cpp.
int run_new_from_c(const NewControlObjectOptions& options, std::string_view main_template);

// Each puts a command into the group `new`. When what it runs throws InputError, nothing is written.
void add_new_control_object(CLI::App& made, CommandLine& line);
void add_new_robot(CLI::App& made, CommandLine& line);
void add_new_behavior(CLI::App& made, CommandLine& line);
void add_new_scenario(CLI::App& made, CommandLine& line);
void add_new_sweep(CLI::App& made, CommandLine& line);
void add_new_plant(CLI::App& made, CommandLine& line);

}  // namespace kadans
