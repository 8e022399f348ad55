// A URDF text as XML, with the place of every element and a list of the mistakes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

#include "kadans/signal/input_error.h"
#include "source_text.h"
#include "xml_scan.h"

namespace kadans {

class UrdfDocument {
 public:
  // Throws InputError when this is not text, not XML or unreasonably large. Keeps views of the text.
  UrdfDocument(std::string_view text, std::string file);

  const tinyxml2::XMLElement& robot() const { return *xml_.RootElement(); }
  const std::string& file() const noexcept { return file_; }
  int line(const tinyxml2::XMLElement& element) const;

  // Each notes a mistake: at an element, at the name or the value of one of its attributes (at the element when it has
  // no such attribute), or at the text inside it. The mistake that fills the list throws.
  void refuse(const tinyxml2::XMLElement& element, std::string message);
  void refuse_name(const tinyxml2::XMLElement& element, std::string_view attribute, std::string message);
  void refuse_value(const tinyxml2::XMLElement& element, std::string_view attribute, std::string message);
  bool has_text(const tinyxml2::XMLElement& element) const;
  void refuse_text(const tinyxml2::XMLElement& element, std::string message);

  bool refused() const noexcept { return !problems_.empty(); }
  void throw_if_refused();  // InputError with all mistakes, sorted by place

  // The text without comments, foreign elements and stray blanks, as urdfdom gets it.
  std::string reprinted() const;

 private:
  const XmlTag& tag(const tinyxml2::XMLElement& element) const;
  const XmlAttribute* attribute(const tinyxml2::XMLElement& element, std::string_view name) const;
  void link_tags();
  void refuse_at(std::size_t at, std::string message);

  std::string file_;
  SourceText source_;
  XmlScan scan_;
  tinyxml2::XMLDocument xml_;
  std::vector<InputProblem> problems_;
};

// "" when the element has no such attribute.
std::string attribute_or_empty(const tinyxml2::XMLElement& element, const char* name);

}  // namespace kadans
