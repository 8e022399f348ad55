#include "mjcf_source.h"

#include <algorithm>
#include <filesystem>

#include "model/urdf/urdf_description.h"
#include "model/xml_scan.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr std::size_t most_open = 8, most_files = 1000;

// Where the '>' of a start tag is.
std::size_t end_of_tag(std::string_view text, const XmlTag& tag) {
  if (tag.attributes.empty()) return text.find('>', tag.at);
  const std::size_t value_at = tag.attributes.back().value_at;
  return text.find('>', text.find(text[value_at - 1], value_at));
}

// Behind an element without children.
std::size_t end_of_element(std::string_view text, const XmlTag& tag) {
  const std::size_t end = end_of_tag(text, tag);
  if (end == std::string_view::npos) return text.size();
  if (text[end - 1] == '/') return end + 1;
  const std::size_t close = text.find('>', text.find("</", end));
  return close == std::string_view::npos ? text.size() : close + 1;
}

// What stands between the root's tags.
std::string_view inside_root(std::string_view text, const XmlScan& scan) {
  if (scan.tags.empty()) return {};
  const std::size_t open = end_of_tag(text, scan.tags.front()), close = text.rfind("</");
  if (open == std::string_view::npos || close == std::string_view::npos || text[open - 1] == '/' || close < open)
    return {};
  return text.substr(open + 1, close - open - 1);
}

}  // namespace

MjcfSource::MjcfSource(const std::string& text, const std::string& file) {
  std::vector<std::string> open;
  lines_.emplace_back();
  add(text, file, open);
}

// Blanks keep what follows in the columns that it has in its file.
void MjcfSource::add_text(std::string_view text, std::size_t file, int& line) {
  for (const char c : text) {
    text_ += c;
    if (c != '\n') continue;
    lines_.push_back({file, ++line});
  }
  if (text_.size() > description_max_bytes) refuse(files_[0], "the file has more than 2 MiB with what it includes");
}

void MjcfSource::add(const std::string& text, const std::string& file, std::vector<std::string>& open) {
  const SourceText source(text);
  const XmlScan scan = scan_xml(source);
  const std::size_t number = files_.size();
  files_.push_back(file);
  open.push_back(std::filesystem::path(file).lexically_normal().string());
  lines_.back() = {number, 1};
  int line = 1;
  std::size_t at = 0, until = text.size();
  if (number > 0) {
    const std::string_view inside = inside_root(text, scan);
    at = inside.empty() ? text.size() : static_cast<std::size_t>(inside.data() - text.data());
    until = at + inside.size();
    line = source.place(at).line;
    lines_.back() = {number, line};
    text_.append(static_cast<std::size_t>(std::max(source.place(at).column - 1, 0)), ' ');
  }
  for (const XmlTag& tag : scan.tags) {
    if (tag.name != "include" || tag.at < at || tag.at >= until || scan.problem) continue;
    const TextPlace place = source.place(tag.at);
    const auto named = std::ranges::find(tag.attributes, "file", &XmlAttribute::name);
    const auto refuse = [&](const std::string& what) {
      throw InputError({.file = file, .line = place.line, .column = place.column, .message = what});
    };
    if (named == tag.attributes.end()) refuse("<include> has no attribute 'file'");
    const std::size_t quote = named->value_at - 1;
    const std::string name = text.substr(named->value_at, text.find(text[quote], named->value_at) - named->value_at);
    const std::filesystem::path path = std::filesystem::path(files_[0]).parent_path() / name;
    if (std::ranges::find(open, path.lexically_normal().string()) != open.end())
      refuse("<include> of " + shown_quoted(name) + ", which includes this file");
    if (open.size() >= most_open || files_.size() >= most_files) refuse("<include>s are too many, or too deep");
    if (!std::filesystem::is_regular_file(path)) refuse("<include> of " + shown_quoted(name) + ", which is not there");
    add_text(std::string_view(text).substr(at, tag.at - at), number, line);
    text_ += '\n';
    lines_.emplace_back();
    add(read_input_file(path.string(), description_max_bytes), path.string(), open);
    at = end_of_element(text, tag);
    const TextPlace behind = source.place(at);
    line = behind.line;
    text_ += '\n';
    lines_.push_back({number, line});
    text_.append(static_cast<std::size_t>(std::max(behind.column - 1, 0)), ' ');
  }
  add_text(std::string_view(text).substr(std::min(at, until), until - std::min(at, until)), number, line);
  open.pop_back();
}

std::vector<InputProblem> MjcfSource::placed(std::vector<InputProblem> problems) const {
  for (InputProblem& problem : problems) {
    if (problem.line < 1 || static_cast<std::size_t>(problem.line) > lines_.size()) continue;
    const Line& from = lines_[static_cast<std::size_t>(problem.line) - 1];
    problem.file = files_[from.file];
    problem.line = from.line;
  }
  return problems;
}

}  // namespace kadans
