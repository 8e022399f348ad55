#include "junit.h"

#include <algorithm>

#include <tinyxml2.h>

#include "signal/number_text.h"
#include "signal/utf8.h"
#include "suite_report.h"

namespace kadans {
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

Verdict verdict_of(RunStatus status) {
  switch (status) {
    case RunStatus::passed:
      return Verdict::passed;
    case RunStatus::failed:
      return Verdict::failed;
    case RunStatus::cancelled:
      return Verdict::skipped;
    default:
      return Verdict::error;
  }
}

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
                  .verdict = verdict_of(run.status),
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
