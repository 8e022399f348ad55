// Man pages and the manual's page of commands, made from the same table as --help.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace kadans {

// The page of the program or of a command, in man(7), with the verbs of a group in it. `words` is "kadans" or
// "kadans sim".
std::string man_page(const CLI::App& command, const std::string& words);

// All commands of the program as Markdown.
std::string command_reference(const CLI::App& program);

}  // namespace kadans
