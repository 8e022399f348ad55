#include <cstdio>

#include <CLI/CLI.hpp>

#include "app/terminal.h"
#include "campaign/sweep/sweep_summary.h"
#include "campaign/work/durable_file.h"
#include "config/json/problems.h"
#include "sweep_command.h"

namespace kadans {
namespace {

HeatMapOptions map_of(const MergeOptions& options, const SweepManifest& manifest) {
  const auto chosen = [](const std::string& given, const std::string& planned) {
    return given.empty() ? planned : given;
  };
  HeatMapOptions map{.x = chosen(options.x, manifest.map_x),
                     .y = chosen(options.y, manifest.map_y),
                     .metric = chosen(options.metric, manifest.map_metric)};
  if (map.x.empty() || map.y.empty())
    refuse("--heat-map", {}, "the plan names no heat_map; name two quantities with --x and --y");
  return map;
}

}  // namespace

int run_merge(const MergeOptions& options) {
  std::vector<SweepResults> parts;
  for (const std::string& folder : options.folders) parts.emplace_back(folder);
  const MergedSweep sweep = merge(parts);
  if (!options.heat_map.empty()) write_durably(options.heat_map, heat_map_svg(sweep, map_of(options, sweep.manifest)));
  if (!options.csv.empty()) write_durably(options.csv, csv_table(sweep));
  if (!options.sqlite.empty()) write_sqlite(sweep, options.sqlite);
  std::fputs(options.json ? (sweep_json(sweep) + "\n").c_str() : sweep_summary(sweep).c_str(), stdout);
  return passed(sweep) ? exit_passed : exit_failed;
}

void add_merge(CLI::App& app, MergeOptions& options) {
  CLI::App* merge = app.add_subcommand("merge", "Join the results of a sweep's parts in one table");
  merge->add_option("folders", options.folders, "Folders of results")->required()->type_name("FOLDER...");
  merge->add_option("--sqlite", options.sqlite, "Write a database with the table cases")->type_name("FILE");
  merge->add_option("--csv", options.csv, "Write the table as text")->type_name("FILE");
  CLI::Option* map = merge->add_option("--heat-map", options.heat_map, "Draw the results over two quantities (SVG)")
                         ->type_name("FILE");
  merge->add_option("--x", options.x, "Quantity on the horizontal axis (default: the plan's)")
      ->type_name("NAME")
      ->needs(map);
  merge->add_option("--y", options.y, "Quantity on the vertical axis (default: the plan's)")
      ->type_name("NAME")
      ->needs(map);
  merge
      ->add_option("--metric", options.metric,
                   "Metric that is drawn (default: the plan's, else the share of runs that passed)")
      ->type_name("NAME")
      ->needs(map);
  merge->add_flag("--json", options.json, "Print one JSON object instead of text");
}

}  // namespace kadans
