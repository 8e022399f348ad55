// Runs the program as a person would, in a folder of the test's own.
#pragma once

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace kadans::program {

struct Outcome {
  int exit_code = -1;  // 128 + signal when it was killed
  std::string out, err;
};

// `arguments` as typed in a shell, in folder `where`; "<file" among them is its input, else there is none.
Outcome run(const std::string& arguments, const std::filesystem::path& where);

// The program while it runs beside the test, and what it says. It does not outlive this object.
class Running {
 public:
  // As for run(); "2>file" or ">file" among the arguments keeps that output from this object.
  Running(const std::filesystem::path& where, const std::string& arguments);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  // Reads on until a line of its output holds the text. False: the program ended without it.
  bool says(const std::string& text);
  void signal(int number) const { kill(pid_, number); }
  // Reads to the end. The exit code, 128 + signal when that killed it.
  int end();
  int end(int number) {
    signal(number);
    return end();
  }
  pid_t pid() const noexcept { return pid_; }
  int output() const { return fileno(output_); }  // a descriptor that can be read
  const std::string& heard() const noexcept { return heard_; }

 private:
  pid_t pid_ = -1;
  std::FILE* output_ = nullptr;
  std::string heard_;
  bool ended_ = false;
};

// Of DDS: one that no other process of these tests has while this one runs.
int own_dds_domain();

// A fresh folder below the build folder, emptied first, this process's own; gone when the process ends.
std::filesystem::path fresh_folder(const std::string& name);
// The same with copies of the project's config, models and behaviors in it.
std::filesystem::path project_copy(const std::string& name);

std::string read(const std::filesystem::path& file);
void write(const std::filesystem::path& file, const std::string& text);
// Replaces the first `from` in the file by `to`; false when it is not there.
bool edit(const std::filesystem::path& file, const std::string& from, const std::string& to);

// How many runs have their results below this folder, each in a folder "cases" of what it belongs to.
std::size_t results_in(const std::filesystem::path& folder);

// The flight records in this folder.
std::vector<std::filesystem::path> flights_in(const std::filesystem::path& folder);
// Replays copies of a record, each damaged in another place: the program says something of it, and ends properly.
void check_damaged(const std::filesystem::path& record);

// The numbers of a table as `log csv` prints it, without its head: a row for each line.
std::vector<std::vector<double>> rows_of_table(const std::string& csv);

// The last line that is not empty, without its end.
std::string last_line(const std::string& text);

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace kadans::program
