// The pages of reference that are made from the program's own tables: man pages and pages of the manual, as Markdown.
#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

namespace kadans {

// The page of the program or of a command, in man(7), with the verbs of a group in it. `words` is "kadans" or
// "kadans sim".
std::string man_page(const CLI::App& command, const std::string& words);

// completion.cpp. The script by which a shell ("bash" or "zsh") completes the program's commands.
std::string completion_script(const CLI::App& program, const std::string& shell);

// All commands of the program.
std::string command_reference(const CLI::App& program);

// All fields of the JSON files: robots, scenarios, sweeps, tunings.
std::string field_reference();

// The types of control objects with their parameters, set-points and signals, as the robots of a project use them.
// Throws InputError.
std::string object_reference(const std::filesystem::path& root);

// The text as a table of Markdown shows it: what Markdown would take for something else is escaped.
std::string markdown_text(const std::string& text);

}  // namespace kadans
