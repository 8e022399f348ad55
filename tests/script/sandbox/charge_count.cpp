// Counts what the C functions of the sandbox do, in instructions of the machine under callgrind, and holds that against
// what they charge.
//   charge_count           exit code 1 when one does more than its charge allows; 77 without valgrind
//   charge_count --work    runs all cases, to be counted: a line each with its charge
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>
#include <valgrind/callgrind.h>

#include "charge_cases.h"

using namespace kadans::script_test;

namespace {

// An instruction of a script takes some ten of the machine. What is charged for may take a few times that: it is there
// to stop what lasts, not to keep accounts. And each call may take a moment uncharged, and so may each value that is
// handed over, which costs the interpreter as much. Counts differ by a few in a hundred from run to run.
constexpr double machine_per_instruction = 56, machine_per_call = 6000, machine_per_value = 20;

// The C library has copies and sines of its own for each kind of processor: all machines shall take the same.
constexpr const char* plain_processor =
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-AVX512F,-AVX512VL,-AVX512BW,-FMA,-FMA4,-ERMS,-FSRM ";

int work() {
  ChargedScript script;
  for (const ChargeCase& of : charge_cases()) {
    const ChargedScript::Charge charge = script.run(of);
    CALLGRIND_DUMP_STATS;
    std::printf("%.0f %.0f %s\n", charge.instructions, charge.values, charge.error.c_str());
  }
  return 0;
}

double counted(const std::filesystem::path& file) {
  std::ifstream in(file);
  for (std::string word; in >> word;) {
    double count = 0;
    if (word == "totals:" && in >> count) return count;
  }
  return 0;
}

struct Line {
  double charged = 0, values = 0;
  std::string error;
};

std::vector<Line> read_lines(const std::filesystem::path& file) {
  std::vector<Line> lines;
  std::ifstream in(file);
  for (std::string text; std::getline(in, text);) {
    std::istringstream fields(text);
    Line& line = lines.emplace_back();
    fields >> line.charged >> line.values;
    std::getline(fields >> std::ws, line.error);
  }
  return lines;
}

int compare(const std::filesystem::path& folder) {
  const std::vector<Line> lines = read_lines(folder / "charges");
  int wrong = lines.size() == charge_cases().size() ? 0 : 1;
  std::printf("%10s %10s %8s  %s\n", "counted", "charged", "each", "function");
  for (std::size_t i = 0; i < std::min(lines.size(), charge_cases().size()); ++i) {
    const double machine = counted(folder / ("out." + std::to_string(i + 1)));
    const bool good =
        lines[i].error.empty() && machine > 0 &&
        machine <= machine_per_call + machine_per_value * lines[i].values + machine_per_instruction * lines[i].charged;
    if (!good) ++wrong;
    const double each = std::max(0.0, machine - machine_per_call) / std::max(1.0, lines[i].charged);
    std::printf("%10.0f %10.0f %8.1f  %s%s %s\n", machine, lines[i].charged, each, charge_cases()[i].function,
                good ? "" : "  <-- more than charged", lines[i].error.c_str());
  }
  std::printf("%d of %zu functions work longer than they are charged\n", wrong, charge_cases().size());
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 1) return work();
  if (std::system("valgrind --tool=callgrind --version >/dev/null 2>&1") != 0) return 77;
  const auto folder = std::filesystem::temp_directory_path() / ("kadans_charges_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ostringstream command;
  command << plain_processor
          << "valgrind --tool=callgrind --toggle-collect=kadans_charged_call '--callgrind-out-file=" << folder.string()
          << "/out' '" << arguments[0] << "' --work >" << folder.string() << "/charges 2>" << folder.string() << "/log";
  const int code = std::system(command.str().c_str()) == 0 ? compare(folder) : 1;
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return code;
}
