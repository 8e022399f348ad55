#include <cstdio>
#include <map>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "report.h"

int main(int argc, char** argv) {
  using namespace kadans::bench;
  const std::map<std::string, void (*)(Report&)> parts = {
      {"body", bench_body},         {"bus", bench_bus},     {"control", bench_control},
      {"exchange", bench_exchange}, {"live", bench_live},   {"lua", bench_lua},
      {"objects", bench_objects},   {"plant", bench_plant}, {"precision", bench_precision},
      {"record", bench_record},     {"start", bench_start}, {"switch", bench_switch},
      {"wall", bench_wall}};
  CLI::App app("Kadans benchmarks", "kadans_bench");
  std::vector<std::string> only;
  bool json = false;
  std::vector<std::string> names;
  for (const auto& [name, run] : parts) names.push_back(name);
  app.add_option("--only", only, "Parts to run (default: all)")->check(CLI::IsMember(names))->delimiter(',');
  app.add_flag("--json", json, "Print one JSON object");
  CLI11_PARSE(app, argc, argv);
  Report report;
  try {
    for (const auto& [name, run] : parts) {
      if (!only.empty() && std::find(only.begin(), only.end(), name) == only.end()) continue;
      std::fprintf(stderr, "bench: %s\n", name.c_str());
      run(report);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
  }
  if (json) {
    report.print_json();
  } else {
    report.print_table();
  }
  return 0;
}
