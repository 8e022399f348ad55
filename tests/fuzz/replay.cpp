// Gives files to a fuzz target once, without libFuzzer: each argument is a file, or a folder of files. An input that
// takes longer than a second of processor time ends the program; its name stands before.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/time.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

// What libFuzzer is told in scripts/fuzz; a sanitizer takes more, of both.
#ifdef KADANS_SANITIZED
constexpr time_t seconds_max = 10;
constexpr rlim_t bytes_max = RLIM_INFINITY;
#else
constexpr time_t seconds_max = 1;
constexpr rlim_t bytes_max = rlim_t{1} << 30U;
#endif

std::vector<fs::path> files_of(int count, char** arguments) {
  std::vector<fs::path> files;
  for (int i = 1; i < count; ++i) {
    if (!fs::is_directory(arguments[i])) {
      files.emplace_back(arguments[i]);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(arguments[i])) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  return files;
}

void give(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const itimerval limit{.it_interval = {}, .it_value = {.tv_sec = seconds_max, .tv_usec = 0}}, none{};
  setitimer(ITIMER_PROF, &limit, nullptr);  // its signal ends the program
  (void)LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  setitimer(ITIMER_PROF, &none, nullptr);
}

}  // namespace

int main(int count, char** arguments) {
  const rlimit memory{.rlim_cur = bytes_max, .rlim_max = bytes_max};
  setrlimit(RLIMIT_AS, &memory);
  const std::vector<fs::path> files = files_of(count, arguments);
  if (files.empty()) return std::fputs("replay: name files, or folders of files\n", stderr), 2;
  for (const fs::path& file : files) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);
    give(file);
  }
  std::printf("%zu inputs\n", files.size());
  return 0;
}
