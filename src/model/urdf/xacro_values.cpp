#include "xacro_values.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string_view>
#include <vector>

#include "model/xml_scan.h"

namespace kadans {
namespace {

struct Edit {  // of the text, in its order
  std::size_t at = 0, length = 0;
  std::string by;
};

std::string in_attribute(std::string_view value) {
  std::string text;
  for (const char c : html_text(value)) {
    if (c == '\'')
      text += "&apos;";
    else
      text += c;
  }
  return text;
}

class XacroReader {
 public:
  XacroReader(const std::string& text, const std::string& file) : text_(text), file_(file), source_(text) {}

  std::optional<XacroValues> run() {
    const XmlScan scan = scan_xml(source_);
    if (scan.problem) return std::nullopt;
    for (const XmlTag& tag : scan.tags) {
      if (!read(tag)) return std::nullopt;
    }
    if (edits_.empty()) return std::nullopt;
    XacroValues result;
    std::size_t at = 0;
    for (const Edit& edit : edits_) {
      result.text.append(text_, at, edit.at - at).append(edit.by);
      at = edit.at + edit.length;
    }
    result.text.append(text_, at);
    std::string message = "values are put in for names of xacro: ";
    std::size_t count = 0;
    for (const auto& [name, value] : taken_) {
      constexpr std::size_t most = 6;
      if (count++ == most) message += ", ...";
      if (count <= most) message.append(count == 1 ? "" : ", ").append(name).append(" is ").append(value);
    }
    const TextPlace place = source_.place(first_);
    if (taken_.empty()) message = "the arguments of xacro are used nowhere";
    result.told = {file_, place.line, place.column, message};
    return result;
  }

 private:
  // Values of values grow by themselves: no robot needs that much.
  static constexpr std::size_t most_grown = std::size_t{2} << 20U;

  // False for what is more than names of values.
  bool read(const XmlTag& tag) {
    std::map<std::string, std::string> values;  // of its attributes
    std::vector<Edit> edits;
    for (const XmlAttribute& attribute : tag.attributes) {
      const std::size_t end = text_.find(text_[attribute.value_at - 1], attribute.value_at);
      const std::string_view given = std::string_view(text_).substr(attribute.value_at, end - attribute.value_at);
      std::string value = with_values(given, attribute.value_at);
      if (grown_ > most_grown) return false;
      if (value != given) edits.push_back({attribute.value_at, given.size(), value});
      values[std::string(attribute.name)] = std::move(value);
    }
    if (!tag.name.starts_with("xacro:")) {
      edits_.insert(edits_.end(), edits.begin(), edits.end());
      return true;
    }
    const bool is_argument = tag.name == "xacro:arg";
    const char* const from = is_argument ? "default" : "value";
    const std::size_t end = tag.attributes.empty() ? std::string::npos : text_.find('>', end_of(tag));
    if ((!is_argument && tag.name != "xacro:property") || end == std::string::npos || text_[end - 1] != '/' ||
        !values.contains("name"))
      return false;
    if (values.contains(from)) (is_argument ? arguments_ : properties_).emplace(values["name"], values[from]);
    if (!is_argument && !values.contains(from)) return false;
    std::string blanks(end + 1 - tag.at, ' ');
    for (std::size_t i = 0; i < blanks.size(); ++i) {
      if (text_[tag.at + i] == '\n') blanks[i] = '\n';
    }
    edits_.push_back({tag.at, blanks.size(), blanks});
    return true;
  }

  std::size_t end_of(const XmlTag& tag) const {  // of its last attribute
    const std::size_t value_at = tag.attributes.back().value_at;
    return text_.find(text_[value_at - 1], value_at);
  }

  std::string with_values(std::string_view given, std::size_t at) {
    std::string result;
    for (std::size_t i = 0; i < given.size();) {
      const bool call = given.substr(i).starts_with("$("), name = given.substr(i).starts_with("${");
      const std::size_t end = call ? given.find(')', i) : name ? given.find('}', i) : std::string_view::npos;
      const auto value = end == std::string_view::npos || (i > 0 && given[i - 1] == '$')
                             ? std::nullopt
                             : value_of(trimmed(given.substr(i + 2, end - i - 2)), call);
      if (!value) {
        result += given[i++];
        continue;
      }
      if (first_ == 0) first_ = at + i;
      result += *value;
      grown_ += value->size();
      if (grown_ > most_grown) return result;
      i = end + 1;
    }
    return result;
  }

  std::optional<std::string> value_of(std::string_view inside, bool call) {
    if (!call) return take(std::string(inside), properties_, std::string(inside), "its property");
    const std::size_t word = std::min(inside.find_first_of(xml_blanks), inside.size());
    const std::string_view kind = inside.substr(0, word), rest = trimmed(inside.substr(word));
    const std::size_t blank = std::min(rest.find_first_of(xml_blanks), rest.size());
    const std::string name(rest.substr(0, blank));
    if (kind == "arg" && blank == rest.size()) return take(name, arguments_, name, "its default");
    if ((kind != "env" && kind != "optenv") || name.empty()) return std::nullopt;
    if (const char* const set = std::getenv(name.c_str()); set != nullptr)
      return take(name, {{name, in_attribute(set)}}, name, "the environment");
    if (kind != "optenv") return std::nullopt;
    return take(name, {{name, std::string(trimmed(rest.substr(blank)))}}, name, "its default");
  }

  std::optional<std::string> take(const std::string& name, const std::map<std::string, std::string>& from,
                                  const std::string& key, const char* by) {
    const auto found = from.find(key);
    if (found == from.end()) return std::nullopt;
    taken_.emplace(shown_quoted(name), shown_quoted(found->second) + " (" + by + ")");
    return found->second;
  }

  const std::string& text_;
  const std::string& file_;
  SourceText source_;
  std::map<std::string, std::string> arguments_, properties_, taken_;
  std::vector<Edit> edits_;
  std::size_t first_ = 0, grown_ = 0;
};

}  // namespace

std::optional<XacroValues> with_xacro_values(const std::string& text, const std::string& file) {
  return XacroReader(text, file).run();
}

}  // namespace kadans
