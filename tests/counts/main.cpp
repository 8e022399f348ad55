// Counts the instructions of the hot paths and holds them against counts.json.
//   kadans_counts              exit code 1 when one has grown by more than a tenth; 77, nothing compared, without
//                              valgrind or when compiler or libraries are not those of the recorded counts
//   kadans_counts --renew      writes counts.json anew
//   kadans_counts --path NAME  does the work of one path, to be counted
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>

#include <gnu/libc-version.h>
#include <nlohmann/json.hpp>

#include "callgrind.h"
#include "paths.h"

namespace kadans::counts {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* file = KADANS_SOURCE_DIR "/tests/counts/counts.json";
constexpr double growth_max = 0.1;
constexpr int skipped = 77;

// What the counts depend on beside our sources.
Json made_with() {
  return {{"compiler", "gcc " __VERSION__}, {"build", KADANS_BUILD_TYPE}, {"machine", KADANS_MACHINE},
          {"libc", gnu_get_libc_version()}, {"bullet", KADANS_BULLET},    {"luajit", KADANS_LUAJIT},
          {"orocos_kdl", KADANS_OROCOS_KDL}};
}

int work(std::string_view name) {
  for (const Path& path : paths()) {
    if (path.name != name) continue;
    path.run(path.calls);
    return 0;
  }
  std::fprintf(stderr, "counts: there is no path '%s'\n", std::string(name).c_str());
  return 2;
}

// Instructions a call, by path; null where nothing could be counted.
Json count_all(const std::string& program) {
  Json counts = Json::object();
  for (const Path& path : paths()) {
    const auto total = count_instructions(program, path.name, path.function);
    counts[path.name] = total ? Json(std::llround(*total / path.calls)) : Json();
    if (!total) std::fprintf(stderr, "counts: no call of %s was counted\n", path.function);
  }
  return counts;
}

// How many paths are worse than recorded.
int compare(const Json& recorded, const Json& now) {
  int worse = 0;
  for (const auto& [name, count] : now.items()) {
    if (count.is_null() || !recorded.contains(name)) {
      std::printf("%-26s not counted, or not in counts.json\n", name.c_str());
      ++worse;
      continue;
    }
    const double before = recorded[name], growth = count.get<double>() / before - 1;
    const char* const verdict = growth > growth_max    ? "  more than 10 % over what counts.json has"
                                : growth < -growth_max ? "  less by so much that counts.json wants renewing"
                                                       : "";
    std::printf("%-26s %8.0f -> %8.0f instructions a call, %+6.1f %%%s\n", name.c_str(), before, count.get<double>(),
                100 * growth, verdict);
    if (growth > growth_max) ++worse;
  }
  return worse;
}

int check(const std::string& program) {
  std::ifstream in(file);
  const Json recorded = Json::parse(in);
  if (recorded["made_with"] != made_with()) {
    std::printf("skipped: the counts were made with %s,\nthis is %s\n", recorded["made_with"].dump().c_str(),
                made_with().dump().c_str());
    return skipped;
  }
  const int worse = compare(recorded["instructions_a_call"], count_all(program));
  if (worse == 0) return 0;
  std::printf("If that is meant: scripts/counts --renew, and the reason into the commit.\n");
  return 1;
}

int renew(const std::string& program) {
  const Json counts = count_all(program);
  std::ofstream(file) << Json{{"made_with", made_with()}, {"instructions_a_call", counts}}.dump(2) << '\n';
  std::printf("%s\n", counts.dump(2).c_str());
  return 0;
}

int run(int argc, char** argv) {
  const std::string_view first = argc > 1 ? argv[1] : "";
  if (first == "--path" && argc == 3) return work(argv[2]);
  if (!first.empty() && first != "--renew") {
    std::fprintf(stderr, "counts: there is only --renew\n");
    return 2;
  }
  if (!have_callgrind()) {
    std::printf("skipped: there is no valgrind here; scripts/setup installs it\n");
    return skipped;
  }
  return first == "--renew" ? renew(argv[0]) : check(argv[0]);
}

}  // namespace
}  // namespace kadans::counts

int main(int argc, char** argv) {
  try {
    return kadans::counts::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "counts: %s\n", error.what());
    return 2;
  }
}
