
#include "suite_report.h"

#include <algorithm>
#include <array>

#include <tinyxml2.h>

#include "scenario/report/html_report.h"
#include "signal/number_text.h"
#include "signal/utf8.h"
#include "telemetry/plot.h"

namespace kadans {
namespace {

constexpr std::size_t transitions_shown = 6;

std::string title(const RunOutcome& run) {
  return run.scenario + printed(" (seed %llu)", static_cast<unsigned long long>(run.seed));
}

std::string indented(const std::string& text, const char* by) {
  std::string lines = by;
  for (const char c : text) {
    lines += c;
    if (c == '\n') lines += by;
  }
  return lines;
}

std::string plotted(const EvidenceTrace& trace, const ReportStyle& style) {
  return curve_text(trace.signal + (trace.unit.empty() ? "" : ", " + trace.unit), trace.values, trace.from_s,
                    trace.to_s, {.rows = 3, .indent = 4, .unicode = style.unicode, .color = style.color});
}

std::string checks_of(const RunOutcome& run, const ReportStyle& style) {
  std::string text;
  for (const CheckResult& check : run.checks) {
    if (check.passed) continue;
    text += "    " + style.painted("31", check.name) + printed(": %g at %.3f s", check.value, check.at_s) +
            wanted_clause(check) + '\n';
    for (const EvidenceTrace& trace : run.traces) {
      if (trace.check == check.name && !trace.values.empty()) text += plotted(trace, style);
    }
  }
  return text;
}

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

std::string suite_line(const RunOutcome& run, const ReportStyle& style) {
  const bool passed = run.status == RunStatus::passed;
  const std::string mark =
      passed ? style.painted("32", style.unicode ? "✓" : "ok") : style.painted("31;1", style.unicode ? "✗" : "FAILED");
  std::string text = "  " + mark + " " + title(run) + printed("  %.2f s", run.wall_s);
  if (run.simulated_s > 0 && run.wall_s > 0) text += printed(", %.1f times real time", run.simulated_s / run.wall_s);
  return text + (passed ? "" : std::string("  ") + name(run.status)) + '\n';
}

std::string failure_report(const RunOutcome& run, const ReportStyle& style) {
  std::string text = "  " + style.painted("31;1", title(run)) + ": " + name(run.status) + '\n';
  text += checks_of(run, style);
  for (const std::string& error : run.errors) text += indented(error, "    ") + '\n';
  const std::size_t first = run.transitions.size() > transitions_shown ? run.transitions.size() - transitions_shown : 0;
  for (std::size_t i = first; i < run.transitions.size(); ++i) text += "    " + run.transitions[i] + '\n';
  if (!run.quantities.empty()) {
    text += "    with";
    for (const QuantityValue& quantity : run.quantities)
      text += printed(" %s=%.6g", quantity.name.c_str(), quantity.value);
    text += '\n';
  }
  return text + "    again: " + run.repeat + '\n';
}

std::string suite_summary(const std::vector<RunOutcome>& runs, double wall_s, const ReportStyle& style) {
  std::string text;
  std::size_t failed = 0;
  double run_s = 0, simulated_s = 0;
  for (const RunOutcome& run : runs) {
    run_s += run.wall_s;
    simulated_s += run.simulated_s;
    if (run.status == RunStatus::passed) continue;
    text += (failed++ == 0 ? "\n" : "") + failure_report(run, style);
  }
  text += printed("\n%zu runs, ", runs.size());
  text += failed == 0 ? style.painted("32", "all passed") : style.painted("31;1", printed("%zu failed", failed));
  return text + printed(": %.1f s simulated in %.1f s, %.1f s of work\n", simulated_s, wall_s, run_s);
}

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

namespace {

using Verdict = JunitCase::Verdict;

void add_case(tinyxml2::XMLElement& suite, const JunitCase& one) {
  tinyxml2::XMLElement* const element = suite.InsertNewChildElement("testcase");
  element->SetAttribute("classname", xml_characters(one.file).c_str());
  element->SetAttribute("name", xml_characters(one.name).c_str());
  element->SetAttribute("time", one.wall_s);
  if (one.verdict == Verdict::passed) return;
  if (one.verdict == Verdict::skipped) {
    element->InsertNewChildElement("skipped");
    return;
  }
  tinyxml2::XMLElement* const why =
      element->InsertNewChildElement(one.verdict == Verdict::failed ? "failure" : "error");
  why->SetAttribute("type", xml_characters(one.type).c_str());
  why->SetAttribute("message", xml_characters(one.message).c_str());
  why->SetText(xml_characters(one.text).c_str());
}

// By RunStatus: passed, failed, refused, crashed, timed out, cancelled.
constexpr std::array<Verdict, 6> verdicts{Verdict::passed, Verdict::failed, Verdict::error,
                                          Verdict::error,  Verdict::error,  Verdict::skipped};
static_assert(verdicts.size() == static_cast<std::size_t>(RunStatus::cancelled) + 1);

}  // namespace

std::string junit_document(const std::vector<JunitCase>& cases, double wall_s) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  tinyxml2::XMLElement* const root = document.NewElement("testsuites");
  document.InsertEndChild(root);
  tinyxml2::XMLElement* const suite = root->InsertNewChildElement("testsuite");
  const auto count = [&](Verdict verdict) {
    return static_cast<int>(std::ranges::count(cases, verdict, &JunitCase::verdict));
  };
  for (tinyxml2::XMLElement* element : {root, suite}) {
    element->SetAttribute("name", "kadans");
    element->SetAttribute("tests", static_cast<int>(cases.size()));
    element->SetAttribute("failures", count(Verdict::failed));
    element->SetAttribute("errors", count(Verdict::error));
    element->SetAttribute("skipped", count(Verdict::skipped));
    element->SetAttribute("time", wall_s);
  }
  for (const JunitCase& one : cases) add_case(*suite, one);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string junit_xml(const std::vector<RunOutcome>& runs, double wall_s) {
  std::vector<JunitCase> cases;
  for (const RunOutcome& run : runs) {
    JunitCase one{.file = run.file,
                  .name = run.scenario + " seed " + std::to_string(run.seed),
                  .wall_s = run.wall_s,
                  .verdict = verdicts.at(static_cast<std::size_t>(run.status)),
                  .type = name(run.status),
                  .message = name(run.status),
                  .text = failure_report(run, {.color = false, .unicode = false})};
    for (const CheckResult& check : run.checks) {
      if (!check.passed) one.message += ": " + check.name + printed(" is %g", check.value) + wanted_clause(check);
    }
    cases.push_back(std::move(one));
  }
  return junit_document(cases, wall_s);
}

}  // namespace kadans
