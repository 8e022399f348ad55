#include "callgrind.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace kadans::counts {
namespace {

// The C library has copies of its own for each kind of processor: all machines shall take the same.
constexpr const char* plain_processor =
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-AVX512F,-AVX512VL,-AVX512BW,-FMA,-FMA4,-ERMS,-FSRM ";

int shell(const std::string& command) { return std::system(command.c_str()); }  // NOLINT(concurrency-mt-unsafe)

// The line "totals: 123" of what callgrind writes.
std::optional<double> total(const std::filesystem::path& file) {
  std::ifstream in(file);
  for (std::string word; in >> word;) {
    double count = 0;
    if (word == "totals:" && in >> count && count > 0) return count;
  }
  return std::nullopt;
}

}  // namespace

bool have_callgrind() { return shell("valgrind --tool=callgrind --version >/dev/null 2>&1") == 0; }

std::optional<double> count_instructions(const std::string& program, const std::string& path,
                                         const std::string& function) {
  const auto file = std::filesystem::temp_directory_path() / ("kadans_counts_" + std::to_string(getpid()) + "_" + path);
  const bool ran = shell(plain_processor + ("valgrind --tool=callgrind '--toggle-collect=" + function) +
                         "' '--callgrind-out-file=" + file.string() + "' '" + program + "' --path " + path +
                         " >/dev/null 2>'" + file.string() + ".log'") == 0;
  const std::optional<double> count = ran ? total(file) : std::nullopt;
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  std::filesystem::remove(file.string() + ".log", ignored);
  return count;
}

}  // namespace kadans::counts
