// Runs the program as a person would, in a folder of the test's own.
#pragma once

#include <filesystem>
#include <string>

namespace kadans::program {

struct Outcome {
  int exit_code = -1;  // 128 + signal when it was killed
  std::string out, err;
};

// `arguments` as typed in a shell, in folder `where`; "<file" among them is its input, else there is none.
Outcome run(const std::string& arguments, const std::filesystem::path& where);

// A fresh folder below the build folder, emptied first, this process's own; gone when the process ends.
std::filesystem::path fresh_folder(const std::string& name);
// The same with copies of the project's config, models and behaviors in it.
std::filesystem::path project_copy(const std::string& name);

std::string read(const std::filesystem::path& file);
void write(const std::filesystem::path& file, const std::string& text);
// Replaces the first `from` in the file by `to`; false when it is not there.
bool edit(const std::filesystem::path& file, const std::string& from, const std::string& to);

// The last line that is not empty, without its end.
std::string last_line(const std::string& text);

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace kadans::program
