#include <tinyxml2.h>

#include "kadans/campaign/suite_report.h"

namespace kadans {
namespace {

// XML 1.0 has no control characters but tab and line ends.
std::string clean(const std::string& text) {
  std::string kept;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') kept += c;
  }
  return kept;
}

void add_case(tinyxml2::XMLElement& suite, const RunOutcome& run) {
  tinyxml2::XMLElement* const element = suite.InsertNewChildElement("testcase");
  element->SetAttribute("classname", clean(run.file).c_str());
  element->SetAttribute("name", (clean(run.scenario) + " seed " + std::to_string(run.seed)).c_str());
  element->SetAttribute("time", run.wall_s);
  if (run.status == RunStatus::passed) return;
  if (run.status == RunStatus::cancelled) {
    element->InsertNewChildElement("skipped");
    return;
  }
  const bool failure = run.status == RunStatus::failed;
  tinyxml2::XMLElement* const why = element->InsertNewChildElement(failure ? "failure" : "error");
  std::string message = name(run.status);
  for (const CheckResult& check : run.checks) {
    if (!check.passed) message += ": " + check.name;
  }
  why->SetAttribute("type", name(run.status));
  why->SetAttribute("message", clean(message).c_str());
  why->SetText(clean(failure_report(run, {.color = false, .unicode = false})).c_str());
}

}  // namespace

std::string junit_xml(const std::vector<RunOutcome>& runs, double wall_s) {
  int failures = 0, errors = 0, skipped = 0;
  for (const RunOutcome& run : runs) {
    if (run.status == RunStatus::cancelled)
      ++skipped;
    else if (run.status == RunStatus::failed)
      ++failures;
    else if (run.status != RunStatus::passed)
      ++errors;
  }
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  tinyxml2::XMLElement* const root = document.NewElement("testsuites");
  document.InsertEndChild(root);
  tinyxml2::XMLElement* const suite = root->InsertNewChildElement("testsuite");
  for (tinyxml2::XMLElement* element : {root, suite}) {
    element->SetAttribute("name", "kadans");
    element->SetAttribute("tests", static_cast<int>(runs.size()));
    element->SetAttribute("failures", failures);
    element->SetAttribute("errors", errors);
    element->SetAttribute("skipped", skipped);
    element->SetAttribute("time", wall_s);
  }
  for (const RunOutcome& run : runs) add_case(*suite, run);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace kadans
