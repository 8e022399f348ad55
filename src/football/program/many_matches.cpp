#include "many_matches.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "kadans/campaign/job_pool.h"
#include "kadans/config/input_object.h"
#include "kadans/signal/content_hash.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/output_file.h"
#include "kadans/signal/shell_word.h"
#include "match_report.h"

namespace kadans::football {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t matches_max = 100'000, variants_max = 1000;
constexpr double wall_limit_s = 6 * 3600;  // of a match
constexpr const char* plan_file = "plan.json";

struct Case {
  std::size_t number = 0, variant = 0;
  std::uint64_t seed = 0;
  std::string stem() const { return std::to_string(variant) + "-" + std::to_string(seed); }
};

std::vector<Case> cases_of(const ManyMatches& plan, std::size_t variants) {
  if (plan.cases == 0 || variants * plan.cases > matches_max)
    throw InputError({.file = "--cases",
                      .message = std::to_string(variants) + " variants of " + std::to_string(plan.cases) +
                                 " matches: at least one and at most " + std::to_string(matches_max) + " in all"});
  std::vector<Case> cases;
  for (std::size_t variant = 0; variant < variants; ++variant) {
    for (std::uint64_t i = 0; i < plan.cases; ++i) cases.push_back({cases.size(), variant, plan.seed + i});
  }
  return cases;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Of the program, and of the files that matches are made of: those of the folders of the working directory that a
// project has, and what the matches name elsewhere. The folder of the results may be in one of those.
std::string hash_of_players(const ManyMatches& plan, const fs::path& results) {
  ContentHash hash;
  hash.add_file("/proc/self/exe");
  std::set<fs::path> files(plan.files.begin(), plan.files.end()), folders{"behaviors", "models", "config"};
  for (const MatchVariant& variant : variants_of(plan)) {
    for (const TeamSetup& team : read_match(variant.file, variant.settings).teams) {
      folders.insert(team.folder);
      files.insert(team.robot);
    }
  }
  for (const fs::path& folder : folders) {
    hash.add(folder.generic_string());
    for (const char* ending : {".lua", ".json", ".urdf"}) hash.add_folder(folder, ending, results);
  }
  for (const fs::path& file : files) {
    hash.add(file.generic_string());
    hash.add_file(file);
  }
  return hash.hex();
}

std::string texts_json(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + ("{\"text\": " + json_text(text) + "}");
  return "[" + list + "]";
}

std::string json_of_plan(const ManyMatches& plan, const std::string& players) {
  return "{\"players\": \"" + players + "\", \"seed\": " + std::to_string(plan.seed) +
         ", \"cases\": " + std::to_string(plan.cases) + ",\n  \"files\": " + texts_json(plan.files) +
         ",\n  \"settings\": " + texts_json(plan.settings) + ",\n  \"varied\": " + texts_json(plan.varied) + "}\n";
}

ManyMatches read_plan(const fs::path& file) {
  ManyMatches plan;
  std::string players;
  const auto texts = [](InputObject& f, const char* name, std::vector<std::string>& all) {
    f.list(
        name, "",
        [&](InputObject& e) {
          std::string text;
          e.text("text", text, "", true);
          all.push_back(text);
        },
        true);
  };
  read_input_object(file, [&](InputObject& f) {
    f.text("players", players, "", true);
    f.whole("seed", plan.seed, 0, 9'007'199'254'740'992, "", true);
    f.whole("cases", plan.cases, 1, matches_max, "", true);
    texts(f, "files", plan.files);
    texts(f, "settings", plan.settings);
    texts(f, "varied", plan.varied);
  });
  return plan;
}

void keep_plan(const fs::path& folder, const ManyMatches& plan) {
  const std::string text = json_of_plan(plan, hash_of_players(plan, folder));
  const fs::path file = folder / plan_file;
  if (fs::exists(file) && bytes_of(file) != text)
    throw InputError({.file = file.string(),
                      .message =
                          "these are results of other matches, or of another version of the teams, the robots or "
                          "the program: name another folder with --out"});
  write_output_file(file, text);
}

class Played final : public JobWatcher {
 public:
  Played(const std::vector<MatchVariant>& variants, const std::vector<Case>& cases, fs::path folder, bool told,
         bool (*stop)(), std::vector<VariantResults>& results)
      : variants_(variants), cases_(cases), folder_(std::move(folder)), told_(told), stop_(stop), results_(results) {}

  void ended(const JobOutcome& outcome) override {
    const Case& one = cases_[outcome.job];
    VariantResults& variant = results_[one.variant];
    ++done_;
    if (outcome.cancelled) return miss(one, "was stopped");
    if (outcome.timed_out) return miss(one, "took too long");
    if (outcome.signal != 0) return miss(one, "crashed by signal " + std::to_string(outcome.signal));
    if (outcome.out.empty()) return miss(one, outcome.err.substr(0, outcome.err.find('\n')));
    const fs::path file = folder_ / (one.stem() + ".json");
    write_output_file(file, outcome.out);
    variant.results.push_back(read_result(file));
    if (told_) tell(variant.results.back(), one);
  }
  void passed_time(std::size_t) override {}
  bool stop_asked() const override { return stop_(); }

 private:
  void miss(const Case& one, const std::string& why) {
    results_[one.variant].missing.push_back(command_of(variants_[one.variant], one.seed) + ": " + why);
    if (told_) std::fprintf(stderr, "%s\n", results_[one.variant].missing.back().c_str());
  }
  void tell(const MatchResult& result, const Case& one) const {
    std::fprintf(stderr, "%zu of %zu: %s, seed %llu: %u : %u, ended %s\n", done_, cases_.size(),
                 variants_[one.variant].name().c_str(), static_cast<unsigned long long>(one.seed), result.score[0],
                 result.score[1], result.ended.c_str());
  }

  const std::vector<MatchVariant>& variants_;
  const std::vector<Case>& cases_;
  fs::path folder_;
  bool told_;
  bool (*stop_)();
  std::vector<VariantResults>& results_;
  std::size_t done_ = 0;
};

Job job_of(const std::string& program, const MatchVariant& variant, std::uint64_t seed) {
  Job job{{program, "match", variant.file, "--json", "--seed", std::to_string(seed)}, wall_limit_s};
  for (const std::string& setting : variant.settings) {
    job.arguments.emplace_back("--set");
    job.arguments.push_back(setting);
  }
  return job;
}

fs::path new_folder() {
  std::string name = (fs::temp_directory_path() / "kadans-matches-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw InputError({.file = name, .message = "cannot be made: name a folder with --out"});
  return name;
}

std::vector<VariantResults> begun(const std::vector<MatchVariant>& variants) {
  std::vector<VariantResults> results;
  results.reserve(variants.size());
  for (const MatchVariant& variant : variants) results.push_back({variant, {}, {}});
  return results;
}

void sort_by_seed(std::vector<VariantResults>& all) {
  for (VariantResults& one : all) {
    std::ranges::sort(one.results, {}, &MatchResult::seed);
    std::ranges::sort(one.missing);
  }
}

}  // namespace

std::string MatchVariant::name() const {
  std::string text = file;
  for (const std::string& setting : settings) text += " " + setting;
  return text;
}

std::string command_of(const MatchVariant& variant, std::uint64_t seed) {
  std::string command = "kadans-football match " + shell_word(variant.file) + " --seed " + std::to_string(seed);
  for (const std::string& setting : variant.settings) command += " --set " + shell_word(setting);
  return command;
}

std::vector<MatchVariant> variants_of(const ManyMatches& plan) {
  std::vector<MatchVariant> variants;
  for (const std::string& file : plan.files) variants.push_back({file, plan.settings});
  for (const std::string& varied : plan.varied) {
    const std::size_t sign = varied.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == varied.size())
      throw InputError(
          {.file = "--vary", .message = "'" + varied + "' must be KEY=VALUE,VALUE,..., such as network.lost=0,0.3"});
    std::vector<MatchVariant> more;
    for (const MatchVariant& variant : variants) {
      for (std::size_t at = sign + 1; at <= varied.size();) {
        const std::size_t end = std::min(varied.find(',', at), varied.size());
        more.push_back(variant);
        more.back().settings.push_back(varied.substr(0, sign + 1) + varied.substr(at, end - at));
        at = end + 1;
      }
    }
    variants = std::move(more);
    if (variants.size() > variants_max)
      throw InputError({.file = "--vary", .message = "more than " + std::to_string(variants_max) + " variants"});
  }
  for (const MatchVariant& variant : variants) (void)read_match(variant.file, variant.settings);
  return variants;
}

std::vector<VariantResults> play_many(const ManyMatches& plan, const ManyChoices& choices, bool (*stop)()) {
  const std::vector<MatchVariant> variants = variants_of(plan);
  std::vector<VariantResults> results = begun(variants);
  std::vector<Case> cases = cases_of(plan, variants.size());
  fs::path folder = choices.out;
  if (choices.out.empty())
    folder = new_folder();
  else
    keep_plan(folder, plan);
  std::erase_if(cases, [&](const Case& one) {
    if (!choices.shard.holds(one.number)) return true;
    const fs::path file = folder / (one.stem() + ".json");
    if (!fs::exists(file)) return false;
    results[one.variant].results.push_back(read_result(file));
    return true;
  });
  const std::string program = choices.program.empty() ? fs::read_symlink("/proc/self/exe").string() : choices.program;
  std::vector<Job> jobs;
  jobs.reserve(cases.size());
  for (const Case& one : cases) jobs.push_back(job_of(program, variants[one.variant], one.seed));
  Played played(variants, cases, folder, choices.told, stop, results);
  run_jobs(jobs, choices.jobs, played);
  if (choices.out.empty()) fs::remove_all(folder);
  sort_by_seed(results);
  return results;
}

std::vector<VariantResults> merge_many(const std::vector<std::string>& folders) {
  const fs::path first = fs::path(folders.at(0)) / plan_file;
  const ManyMatches plan = read_plan(first);
  for (const std::string& folder : folders) {
    const fs::path file = fs::path(folder) / plan_file;
    (void)read_plan(file);
    if (bytes_of(file) != bytes_of(first))
      throw InputError({.file = file.string(), .message = "these are results of other matches than " + first.string()});
  }
  std::vector<MatchVariant> variants = variants_of(plan);
  std::vector<VariantResults> results = begun(variants);
  for (const Case& one : cases_of(plan, variants.size())) {
    const auto has = [&](const std::string& folder) { return fs::exists(fs::path(folder) / (one.stem() + ".json")); };
    const auto found = std::ranges::find_if(folders, has);
    if (found == folders.end())
      results[one.variant].missing.push_back(command_of(variants[one.variant], one.seed) + ": was not played yet");
    else
      results[one.variant].results.push_back(read_result(fs::path(*found) / (one.stem() + ".json")));
  }
  sort_by_seed(results);
  return results;
}

}  // namespace kadans::football
