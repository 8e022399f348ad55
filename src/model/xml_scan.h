// Where the elements and attributes of an XML text stand. tinyxml2 reads the values but knows only lines. This scan
// finds every start tag and its attributes byte for byte, in the order of the document. It describes the most common
// XML mistakes (a tag that is not closed or closed by another one, a missing quote) better than a parser's error code.
// It also bounds what the parsers after it get: depth, elements, attributes, no document type declarations.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "source_text.h"

namespace kadans {

inline constexpr std::size_t max_xml_depth = 64;
inline constexpr std::size_t max_xml_elements = 100000;
inline constexpr std::size_t max_xml_attributes = 64;  // of one element

struct XmlAttribute {
  std::string_view name;
  std::size_t name_at = 0, value_at = 0;  // bytes; value_at behind the quote
};

struct XmlTag {
  std::string_view name;
  std::size_t at = 0;                            // the '<'
  std::size_t text_at = std::string_view::npos;  // the first text between its child elements, if any
  std::vector<XmlAttribute> attributes;
};

struct XmlScan {
  std::vector<XmlTag> tags;  // start tags, in the order of the document
  std::optional<TextProblem> problem;
};

XmlScan scan_xml(const SourceText& source);

}  // namespace kadans
