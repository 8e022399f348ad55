#include "suite_page.h"

#include <algorithm>

#include "scenario/report/html_page.h"
#include "scenario/report/html_report.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr const char* number_cell = "<td class=\"number\">";

// Which checks failed, else what the process said.
std::string reasons(const RunOutcome& run) {
  std::string text;
  for (const CheckResult& check : run.checks) {
    if (!check.passed)
      text += "<div>" + html_text(check.name) + printed(": %.5g at %.3f s", check.value, check.at_s) +
              html_text(wanted_clause(check)) + "</div>";
  }
  for (const std::string& error : run.errors) text += "<div>" + html_text(error.substr(0, 400)) + "</div>";
  return text;
}

std::string row(const RunOutcome& run, const std::filesystem::path& folder) {
  const bool passed = run.status == RunStatus::passed;
  const std::string file = report_file(run.scenario, run.seed);
  std::error_code ignored;
  std::string name = html_text(run.scenario);
  if (std::filesystem::exists(folder / file, ignored)) name = "<a href=\"" + file + "\">" + name + "</a>";
  return std::string("<tr><td class=\"mark ") + (passed ? "good\">✓" : "bad\">✗") + "</td><td>" + name + "</td>" +
         number_cell + std::to_string(run.seed) + "</td><td>" + kadans::name(run.status) + "</td>" + number_cell +
         printed("%.2f s", run.simulated_s) + "</td>" + number_cell + printed("%.2f s", run.wall_s) + "</td><td>" +
         reasons(run) + (passed ? "" : "<code>" + html_text(run.repeat) + "</code>") + "</td></tr>\n";
}

}  // namespace

std::string suite_page(const std::vector<RunOutcome>& runs, double wall_s, const std::filesystem::path& folder) {
  std::vector<const RunOutcome*> ordered;  // what failed first
  for (const RunOutcome& run : runs) ordered.push_back(&run);
  const auto has_passed = [](const RunOutcome* run) { return run->status == RunStatus::passed; };
  std::stable_partition(ordered.begin(), ordered.end(), [&](const RunOutcome* run) { return !has_passed(run); });
  const auto passed = static_cast<std::size_t>(std::ranges::count_if(ordered, has_passed));
  double simulated_s = 0;
  for (const RunOutcome& run : runs) simulated_s += run.simulated_s;

  const bool all = passed == runs.size();
  std::string body = std::string("<h1><span class=\"badge ") + (all ? "good\">PASSED" : "bad\">FAILED") + "</span>" +
                     printed("%zu of %zu runs passed", passed, runs.size()) + "</h1>\n<p class=\"dim\">" +
                     printed("%.1f s simulated in %.1f s", simulated_s, wall_s) +
                     "</p>\n<table><tr><th></th><th>scenario</th><th class=\"number\">seed</th><th>verdict</th>"
                     "<th class=\"number\">simulated</th><th class=\"number\">took</th><th></th></tr>\n";
  for (const RunOutcome* run : ordered) body += row(*run, folder);
  return html_page(printed("%zu of %zu runs passed", passed, runs.size()), body + "</table>\n");
}

}  // namespace kadans
