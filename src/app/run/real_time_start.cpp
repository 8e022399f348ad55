#include "real_time_start.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "app/terminal.h"
#include "realtime/machine/machine.h"
#include "realtime/machine/placement.h"

namespace kadans {
namespace {

// TULip squats, walks and falls without any. A machine of 32 bits has half of the memory and half as large pointers.
constexpr std::size_t heap_reserve_bytes = (std::size_t{64} << 10U) * sizeof(void*);

// The arguments with which this program was started, which need not be those that its main() hands on.
std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

}  // namespace

bool rights_suffice(int priority, bool soft) {
  const std::vector<std::string> missing = missing_rights(read_rights("/"), priority);
  for (const std::string& right : missing) print_error((soft ? "going on without " : "missing ") + right);
  if (!missing.empty() && !soft) print_error("--soft goes on without, late as the system likes");
  return missing.empty() || soft;
}

void bind_all_functions() {
  constexpr const char* variable = "LD_BIND_NOW";   // of ld.so; linking with -z now binds only what a file itself calls
  const char* const bound = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): before any thread is started
  if (bound != nullptr && *bound != '\0') return;
  constexpr const char* once = "KADANS_STARTED_ANEW";  // a loader may take LD_BIND_NOW from a program with capabilities
  if (std::getenv(once) != nullptr) return;            // NOLINT(concurrency-mt-unsafe)
  (void)setenv(once, "1", 1);                          // NOLINT(concurrency-mt-unsafe)
  (void)setenv(variable, "1", 1);                      // NOLINT(concurrency-mt-unsafe)
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::vector<std::string> arguments = own_arguments();
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  if (!error && !arguments.empty()) execv(program.c_str(), argv.data());
  print_error(
      std::string("functions of libraries are bound at their first call, in real time too: this program cannot be "
                  "started anew (") +
      (error ? error.message() : std::strerror(errno)) + "); set LD_BIND_NOW=1");
}

void lock_program() noexcept {
  const int refused = lock_memory(heap_reserve_bytes);
  if (refused != 0 && read_rights("/").memory())  // else the missing right was told
    print_error(std::string("going on without locked memory, late when the system swaps: ") + std::strerror(refused));
}

}  // namespace kadans
