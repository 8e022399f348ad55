
#include "xml_scan.h"

#include <algorithm>
#include <array>
#include <string>

#include "signal/number_text.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

bool control(char c) noexcept {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20U && c != '\t' && c != '\n' && c != '\r') || byte == 0x7FU;
}

std::string hex(char c) { return printed("0x%02X", static_cast<unsigned>(static_cast<unsigned char>(c))); }

std::string without_controls(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (control(c) || c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return result;
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
  const std::size_t first = std::min(text.find_first_not_of(xml_blanks), text.size());
  return text.substr(first, text.find_last_not_of(xml_blanks) + 1 - first);
}

std::vector<std::string_view> split(std::string_view text, std::size_t most) {
  std::vector<std::string_view> parts;
  for (text = trimmed(text); !text.empty() && parts.size() < most; text = trimmed(text)) {
    parts.push_back(text.substr(0, text.find_first_of(xml_blanks)));
    text.remove_prefix(parts.back().size());
  }
  return parts;
}

SourceText::SourceText(std::string_view text) : text_(text), lines_{0} {
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1)) {
    lines_.push_back(at + 1);
  }
}

TextPlace SourceText::place(std::size_t at) const noexcept {
  at = std::min(at, text_.size());
  const auto next = std::upper_bound(lines_.begin(), lines_.end(), at);
  const std::size_t start = *(next - 1);
  const std::string_view before = text_.substr(start, at - start);
  return {static_cast<int>(next - lines_.begin()), place_in(before, before.size()).column};
}

std::optional<TextProblem> find_non_text(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '\0') return TextProblem{at, "a NUL byte: this is not a text file"};
    if (control(text[at])) return TextProblem{at, "control character " + hex(text[at]) + " in the text"};
    const std::size_t size = utf8_length(text, at);
    if (size == 0) return TextProblem{at, "byte " + hex(text[at]) + " is not UTF-8: save the file as UTF-8 text"};
    at += size;
  }
  return std::nullopt;
}

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::size_t size = std::min(text.size(), longest);
  while (size > 0 && size < text.size() && inside_character(text[size])) --size;
  return without_controls(text.substr(0, size)) + (size < text.size() ? "..." : "");
}

std::string shown_path_quoted(std::string_view path) {
  constexpr std::size_t longest = 60;
  std::size_t start = path.size() > longest ? path.size() - longest : 0;
  while (start < path.size() && inside_character(path[start])) ++start;
  return std::string(start > 0 ? "'..." : "'") + without_controls(path.substr(start)) + "'";
}

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::size_t npos = std::string_view::npos;

class Scanner {
 public:
  explicit Scanner(const SourceText& source) : source_(source), text_(source.text()) {}

  XmlScan run() {
    if (text_.starts_with(byte_order_mark)) at_ = byte_order_mark.size();
    while (!result_.problem && at_ < text_.size()) {
      between_tags();
      if (!result_.problem && at_ < text_.size()) markup();
    }
    if (!result_.problem && !open_.empty()) {
      const XmlTag& tag = top();
      problem(tag.at, named(tag) + " is not closed: the file ends before " + closing(tag));
    } else if (!result_.problem && result_.tags.empty()) {
      problem(0, "no element in this file: a URDF starts with <robot name=\"...\">");
    }
    return std::move(result_);
  }

 private:
  static std::string named(const XmlTag& tag) { return "<" + shown(tag.name) + ">"; }
  static std::string closing(const XmlTag& tag) { return "</" + shown(tag.name) + ">"; }
  XmlTag& top() { return result_.tags[open_.back()]; }
  void problem(std::size_t at, std::string message) { result_.problem = TextProblem{at, std::move(message)}; }
  void skip_blanks() { at_ = std::min(text_.find_first_not_of(xml_blanks, at_), text_.size()); }

  void between_tags() {
    const std::size_t start = at_;
    skip_blanks();
    const std::size_t text_at = at_;
    at_ = std::min(text_.find('<', start), text_.size());
    if (text_at < at_) note_text(text_at);
  }

  void note_text(std::size_t text_at) {
    if (open_.empty()) {
      problem(text_at, "text outside of the root element");
    } else {
      top().text_at = std::min(top().text_at, text_at);
    }
  }

  void markup() {
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--")) return skip_to("-->", 4, "this comment is not closed by '-->'");
    if (rest.starts_with("<?")) return skip_to("?>", 2, "this declaration is not closed by '?>'");
    if (rest.starts_with("<![CDATA[")) {
      note_text(at_);
      if (!result_.problem) skip_to("]]>", 9, "this CDATA section is not closed by ']]>'");
    } else if (rest.starts_with("<!")) {
      problem(at_, "document type declarations have no place in a URDF");
    } else if (rest.starts_with("</")) {
      end_tag();
    } else {
      start_tag();
    }
  }

  void skip_to(std::string_view end, std::size_t skip, const char* missing) {
    const std::size_t found = text_.find(end, at_ + skip);
    if (found == npos) return problem(at_, missing);
    at_ = found + end.size();
  }

  void end_tag() {
    const std::size_t end = text_.find_first_of("<>", at_ + 1);
    if (end == npos || text_[end] == '<') return problem(at_, "this closing tag has no '>'");
    std::string_view name = text_.substr(at_ + 2, end - at_ - 2);
    name = name.substr(0, name.find_last_not_of(xml_blanks) + 1);
    const std::string here = "</" + shown(name) + ">";
    if (open_.empty()) return problem(at_, here + " closes nothing: no element is open here");
    if (name != top().name) {
      return problem(at_, here + " where " + closing(top()) + " was expected, for the " + named(top()) + " of line " +
                              std::to_string(source_.place(top().at).line));
    }
    open_.pop_back();
    at_ = end + 1;
  }

  std::string_view name_here() {
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n=/><\"'", at_), text_.size());
    const std::string_view name = text_.substr(at_, end - at_);
    at_ = end;
    return name;
  }

  void start_tag() {
    XmlTag tag;
    tag.at = at_++;
    tag.name = name_here();
    if (tag.name.empty()) return problem(tag.at, "'<' without the name of an element behind it");
    if (open_.empty() && !result_.tags.empty()) {
      return problem(tag.at, "a second root element, " + named(tag) + ": a URDF has one");
    }
    if (open_.size() >= max_xml_depth) {
      return problem(tag.at, "elements nested more than " + std::to_string(max_xml_depth) + " deep");
    }
    if (result_.tags.size() >= max_xml_elements) {
      return problem(tag.at, "more than " + std::to_string(max_xml_elements) + " elements");
    }
    const std::optional<bool> stays_open = attributes(tag);
    if (!stays_open) return;
    result_.tags.push_back(std::move(tag));
    if (*stays_open) open_.push_back(result_.tags.size() - 1);
  }

  // Up to the tag's '>'. True when the element stays open, false for <tag/>, nothing when there is a problem.
  std::optional<bool> attributes(XmlTag& tag) {
    while (true) {
      skip_blanks();
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("/>") || rest.starts_with(">")) {
        at_ += rest[0] == '/' ? 2 : 1;
        return rest[0] == '>';
      }
      if (rest.empty() || rest[0] == '<') {
        problem(tag.at, named(tag) + " has no '>'");
        return std::nullopt;
      }
      if (!attribute(tag)) return std::nullopt;
    }
  }

  bool attribute(XmlTag& tag) {
    XmlAttribute attribute;
    attribute.name_at = at_;
    attribute.name = name_here();
    const std::string name = "attribute '" + shown(attribute.name) + "'";
    const auto wrong = [&](const std::string& message) { return problem(attribute.name_at, message), false; };
    if (attribute.name.empty()) return wrong("an attribute's name was expected in " + named(tag));
    const bool twice = std::any_of(tag.attributes.begin(), tag.attributes.end(),
                                   [&](const XmlAttribute& other) { return other.name == attribute.name; });
    if (twice) return wrong(name + " is given twice in " + named(tag));
    if (tag.attributes.size() >= max_xml_attributes) return wrong("too many attributes in " + named(tag));
    skip_blanks();
    if (text_.substr(at_, 1) != "=") return wrong(name + " has no value: '=' was expected");
    ++at_;
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : ' ';
    if (quote != '"' && quote != '\'') return wrong("the value of " + name + " is not in quotes");
    attribute.value_at = ++at_;
    at_ = text_.find_first_of(std::array<char, 3>{quote, '<', '\0'}.data(), at_);
    if (at_ == npos || text_[at_] == '<') return wrong("the value of " + name + " has no closing quote");
    ++at_;
    tag.attributes.push_back(attribute);
    return true;
  }

  const SourceText& source_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::size_t> open_;  // indices of the tags around at_
  XmlScan result_;
};

}  // namespace

XmlScan scan_xml(const SourceText& source) { return Scanner(source).run(); }

std::string_view first_element(std::string_view text) {
  const XmlScan scan = scan_xml(SourceText(text));
  return scan.tags.empty() ? std::string_view() : scan.tags.front().name;
}

}  // namespace kadans
