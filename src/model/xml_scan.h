// The text of a file from outside: checks that it is text, finds the line and column of a byte, and where the elements
// and attributes of an XML text stand.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "signal/utf8.h"

namespace kadans {

// The text of a file from outside: checks that it is text, and finds the line and column of a byte.
struct TextProblem {
  std::size_t at = 0;  // byte
  std::string message;
};

class SourceText {
 public:
  explicit SourceText(std::string_view text);  // keeps a view

  std::string_view text() const noexcept { return text_; }
  TextPlace place(std::size_t at) const noexcept;

 private:
  std::string_view text_;
  std::vector<std::size_t> lines_;  // where each line starts
};

inline constexpr std::string_view xml_blanks = " \t\r\n";
std::string_view trimmed(std::string_view text) noexcept;  // without blanks around it
// The first parts between blanks, at most so many.
std::vector<std::string_view> split(std::string_view text, std::size_t most);

// The first byte that is not UTF-8, or a control character other than tab, line feed and carriage return.
std::optional<TextProblem> find_non_text(std::string_view text);

// For a message: without control characters, cut after 40 characters.
std::string shown(std::string_view text);
inline std::string shown_quoted(std::string_view name) { return "'" + shown(name) + "'"; }
std::string shown_path_quoted(std::string_view path);  // the last 60 characters: its end tells which file it is

// Where the elements and attributes of an XML text stand. tinyxml2 reads the values but knows only lines. This scan
// finds every start tag and its attributes byte for byte, in the order of the document. It describes the most common
// XML mistakes (a tag that is not closed or closed by another one, a missing quote) better than a parser's error code.
// It also bounds what the parsers after it get: depth, elements, attributes, no document type declarations.
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
std::string_view first_element(std::string_view text);  // its name, in the text; "": there is none

}  // namespace kadans
