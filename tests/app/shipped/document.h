// A page of docs/ as something that can be run: its fenced blocks are files, commands and what these print.
//   ```json config/scenarios/mine.json   a file, written into a copy of the project; `kadans check` must accept it
//   ```lua                                a file named by its first line, "-- behaviors/mine.lua"; `kadans behavior
//   check`
//                                         must accept it, unless another word stands behind the fence
//   ```sh                                 commands of kadans, a line each; "# exits N" is the exit code wanted
//   ```sh long                            the same, with KADANS_SOAK=1 in the environment only
//   ```text                               lines that the commands before printed
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/program.h"

namespace kadans::document {

struct Block {
  std::string kind;  // the word behind the fence
  std::string rest;  // what follows it
  std::string text;
  int line = 0;
};

std::vector<Block> blocks_of(const std::string& page);

// Runs the commands of a block, checks their exit codes, returns what they printed.
std::string run_commands(const Block& block, const std::filesystem::path& project);
// Checks that each line of the block was printed; with other physics than the golden hashes', its numbers to a
// hundredth.
void check_shown(const Block& block, const std::string& printed);
// Writes a block that is a file where it says.
void write_file(const Block& block, const std::filesystem::path& project);

// All of the above for a page, below a copy of the project named `folder`.
void check_page(const std::string& page, const std::string& folder);

}  // namespace kadans::document
