#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "campaign/sweep/sweep_case.h"
#include "campaign/sweep/sweep_results.h"
#include "campaign/sweep/sweep_summary.h"
#include "config/json/problems.h"
#include "kadans/campaign/shard.h"
#include "kadans/signal/shell_word.h"
#include "signal/durable_file.h"
#include "sweep_run.h"
#include "sweep_subjects.h"

namespace kadans {
namespace {

// `kadans sweep` runs the cases of a plan, each in a process of its own. `kadans merge` makes one table of the results
// of several sweeps of the same plan.
struct SweepOptions {
  std::string plan;
  std::optional<std::uint32_t> cases;
  std::optional<std::uint64_t> seed;
  unsigned jobs = 0;  // 0: one for each core
  std::string shard;  // "0/4"; "": the shard of a Slurm array, else all cases
  std::string out;    // "": sweeps/NAME-HASH in the working directory
  bool json = false;
};

struct MergeOptions {
  std::vector<std::string> folders;
  std::string sqlite, csv, heat_map;  // files, or ""
  std::string x, y, metric;           // of the heat map; "": the plan's
  bool json = false;
};

HeatMapOptions map_of(const MergeOptions& options, const SweepManifest& manifest) {
  const auto chosen = [](const std::string& given, const std::string& planned) {
    return given.empty() ? planned : given;
  };
  HeatMapOptions map{.x = chosen(options.x, manifest.map_x),
                     .y = chosen(options.y, manifest.map_y),
                     .metric = chosen(options.metric, manifest.map_metric)};
  if (map.x.empty() || map.y.empty())
    refuse("--heat-map", "the plan names no heat_map; name two quantities with --x and --y");
  return map;
}

namespace fs = std::filesystem;

SweepPlan read_plan(const SweepOptions& options) {
  SweepPlan plan = read_sweep_plan(options.plan);
  plan.seed = options.seed.value_or(plan.seed);
  plan.cases = options.cases.value_or(plan.cases);
  return plan;
}

// The results of this shard alone, so that cases of other shards do not count as missing.
MergedSweep part_of(const SweepResults& results, const Shard& shard) {
  MergedSweep part = merge({results});
  std::erase_if(part.rows, [&](const CaseRow& row) { return !shard.holds(row.index); });
  std::erase_if(part.missing, [&](std::size_t index) { return !shard.holds(index); });
  return part;
}

void tell(const MergedSweep& part, const SweepResults& results, const Shard& shard, bool json) {
  if (json) {
    std::puts(sweep_json(part).c_str());
    return;
  }
  std::fputs(sweep_summary(part).c_str(), stdout);
  if (!shard.whole()) std::printf("  this is part %zu/%zu alone\n", shard.index, shard.count);
  const std::string folder = results.folder().string();
  std::printf("  results: %s; as one table: kadans merge %s --csv FILE\n", folder.c_str(), shell_word(folder).c_str());
}

}  // namespace

std::string check_sweep_plan(const std::string& file, const PluginGate& gate) {
  const SweepPlan plan = read_sweep_plan(file);
  const std::vector<SweepSubject> subjects = read_sweep_subjects(plan, gate);
  const std::size_t cases = sweep_cases(plan, subjects, "").size();
  return "sweep: " + std::to_string(cases) + " cases, " + std::to_string(subjects.size()) + " scenarios, " +
         std::to_string(plan.metrics.size()) + " metrics";
}

namespace {

int run_sweep(const SweepOptions& options) {
  require_kind(options.plan, JsonKind::sweep);
  const SweepPlan plan = read_plan(options);
  const std::vector<SweepSubject> subjects = read_sweep_subjects(plan);
  const std::string build = build_version();
  std::vector<SweepCase> cases = sweep_cases(plan, subjects, build);
  const SweepManifest manifest = manifest_of(plan, cases, build);
  const fs::path folder =
      options.out.empty() ? fs::path("sweeps") / (plan.name + "-" + manifest.plan.substr(0, 8)) : fs::path(options.out);
  const Shard shard = options.shard.empty() ? slurm_shard().value_or(Shard{}) : parse_shard(options.shard);
  const SweepResults results(folder, manifest);
  std::erase_if(cases, [&](const SweepCase& one) { return !shard.holds(one.index) || results.has(one); });
  catch_interrupts();
  SweepRun(plan, subjects, results, std::move(cases), options.json).run(options.jobs);
  const MergedSweep part = part_of(results, shard);
  tell(part, results, shard, options.json);
  if (interrupted()) return exit_interrupted;
  return passed(part) ? exit_passed : exit_failed;
}

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

}  // namespace

void add_sweep(CommandLine& line) {
  const auto [sweep, options] =
      line.add<SweepOptions>("sweep", "Run scenarios over a sample of their quantities", run_sweep);
  sweep->add_option("plan", options.plan, "Plan: what is run, and what varies (JSON)")->required()->type_name("PLAN");
  add_whole(*sweep, "--cases", options.cases, 1, sweep_cases_max, "Number of runs (default: the plan's)");
  add_seed(*sweep, options.seed, "Seed of the sample (default: the plan's)");
  add_jobs(*sweep, options.jobs);
  sweep
      ->add_option("--shard", options.shard,
                   "Run only this part of the cases, 0/4 to 3/4 (default: that of the Slurm array)")
      ->type_name("PART/PARTS");
  sweep
      ->add_option("--out", options.out,
                   "Folder of the results; cases that have a result there are not run again (default: in sweeps/)")
      ->type_name("FOLDER");
  sweep->add_flag("--json", options.json, "Print one JSON object a case, and one for the sweep at the end");
}

void add_merge(CommandLine& line) {
  const auto [merge, options] =
      line.add<MergeOptions>("merge", "Join the results of a sweep's parts in one table", run_merge);
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
