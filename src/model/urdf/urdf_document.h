// A URDF text as XML, with the place of every element and a list of the mistakes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

#include "kadans/signal/input_error.h"
#include "model/source_text.h"
#include "model/xml_scan.h"

namespace kadans {

class UrdfDocument {
 public:
  // Throws InputError when this is not text, not XML or unreasonably large. Keeps views of the text.
  UrdfDocument(std::string_view text, std::string file);

  const tinyxml2::XMLElement& root() const { return *xml_.RootElement(); }
  const std::string& file() const noexcept { return file_; }
  static const XmlTag& tag(const tinyxml2::XMLElement& element);
  std::string in_line(std::size_t at) const { return "line " + std::to_string(source_.place(at).line); }

  // Notes a mistake at a byte of the text. The mistake that fills the list throws.
  void refuse(std::size_t at, std::string message);
  // Notes a mistake after which reading cannot go on, and throws.
  [[noreturn]] void stop(std::size_t at, std::string message);
  // Notes an oddity that does not change the model.
  void warn(std::size_t at, std::string message);

  void throw_if_refused();                     // InputError with all that is refused, sorted by place
  std::vector<InputProblem> warnings() const;  // sorted by place

 private:
  void link_tags();
  [[noreturn]] void throw_refused();
  InputProblem problem(std::size_t at, std::string message) const;

  std::string file_;
  SourceText source_;
  XmlScan scan_;
  tinyxml2::XMLDocument xml_;
  std::vector<InputProblem> refused_, warnings_;
  std::size_t warnings_left_out_ = 0;
};

}  // namespace kadans
