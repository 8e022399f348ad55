// Which contents have passed the whole suite of their project: `kadans test` writes it, `kadans push --tested` asks.
// And the lists of lines that are kept between runs for it, and for the runs that failed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

// The hash of what a push of each of these robots would bring now, "" for one that cannot be pushed.
std::vector<std::string> delivery_hashes(const std::vector<std::filesystem::path>& robots);

// In a file of this user's for each project, whose root this is: the newest last. The oldest of many are forgotten.
bool has_passed(const std::filesystem::path& root, const std::string& hash);
void keep_passed(const std::filesystem::path& root, const std::vector<std::string>& hashes);

// The lines of a file that is kept between runs (state_file).
std::vector<std::string> kept_lines(const std::filesystem::path& file);
// Errors of writing are ignored: such a list is only a convenience, and whoever needs a line misses it.
void keep_lines(const std::filesystem::path& file, const std::vector<std::string>& lines);

}  // namespace kadans
