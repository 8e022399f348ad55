// Results as JUnit XML, which CI servers read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace kadans {

struct JunitCase {
  enum class Verdict : std::uint8_t { passed, failed, error, skipped };
  std::string file, name;
  double wall_s = 0;
  Verdict verdict = Verdict::passed;
  std::string type, message, text;  // of a case that did not pass: its kind in a word, one line, the whole text
};

// A <testsuites> document; characters that XML cannot hold are left out.
std::string junit_document(const std::vector<JunitCase>& cases, double wall_s);

}  // namespace kadans
