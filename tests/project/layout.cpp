#include "layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <sstream>

namespace kadans::layout {
namespace {

// A library that only some layers may see. `prefixes` begin the names of its headers.
struct Fence {
  std::string_view library;
  std::vector<std::string_view> prefixes;
  std::vector<std::string_view> folders;  // below src/ or include/kadans/
};

const std::vector<Fence>& fences() {
  static const std::vector<Fence> all{
      {"Lua", {"lua.h", "lauxlib.h", "lualib.h", "luajit.h", "lua.hpp", "luajit-2.1/"}, {"script/"}},
      {"Bullet", {"bt", "Bullet", "LinearMath/", "bullet/"}, {"plant/bullet/", "model/", "app/mesh/"}},
      {"KDL", {"kdl/"}, {"model/"}},
      {"spdlog", {"spdlog/"}, {"engine/behavior_log.cpp"}},
      {"JSON", {"nlohmann/"}, {"config/", "telemetry/", "scenario/", "campaign/", "remote/", "app/"}},
  };
  return all;
}

std::vector<std::string> words(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

std::vector<std::string> lines(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> result;
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

struct Include {
  std::string header;
  bool quoted = false;
};

std::optional<Include> include_in(std::string_view line) {
  const auto skip_blanks = [&line] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skip_blanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(7);
  skip_blanks();
  if (line.empty() || (line.front() != '"' && line.front() != '<')) return std::nullopt;
  const bool quoted = line.front() == '"';
  const auto end = line.find(quoted ? '"' : '>', 1);
  return Include{std::string(line.substr(1, end - 1)), quoted};
}

std::size_t rank(std::string_view layer, const std::vector<std::string>& layers) {
  return static_cast<std::size_t>(std::ranges::find(layers, layer) - layers.begin());
}

std::string place(std::string_view path, std::size_t line) {
  return std::string(path) + ":" + std::to_string(line) + ": ";
}

std::string check_layer(std::string_view own, std::string_view header, const std::vector<std::string>& layers) {
  const std::string other = layer_of(header, layers);
  if (other.empty()) return "includes kadans/" + std::string(header) + ", which belongs to no layer";
  if (rank(other, layers) <= rank(own, layers)) return "";
  return std::string(own) + " includes " + std::string(header) + ", but " + other + " stands below " + std::string(own);
}

// `path` is the including file's.
std::string check_fences(std::string_view path, const Include& include) {
  for (const Fence& fence : fences()) {
    const auto begins = [&include](std::string_view prefix) { return include.header.starts_with(prefix); };
    const auto holds = [path](std::string_view folder) { return path.starts_with(folder); };
    if (!include.quoted && std::ranges::any_of(fence.prefixes, begins) && std::ranges::none_of(fence.folders, holds))
      return "includes <" + include.header + ">, but " + std::string(fence.library) + " has no place here";
  }
  return "";
}

// "plant" for each kadans_plant_bullet or kadans::plant in a line of CMake.
std::vector<std::string> linked_in(std::string_view line) {
  std::vector<std::string> names;
  for (const std::string_view prefix : {"kadans_", "kadans::"}) {
    for (auto at = line.find(prefix); at != std::string_view::npos; at = line.find(prefix, at + 1)) {
      const std::string_view rest = line.substr(at + prefix.size());
      const auto end = std::ranges::find_if(rest, [](unsigned char c) { return std::isalnum(c) == 0; });
      names.emplace_back(rest.begin(), end);
    }
  }
  return names;
}

std::string without_comment(const std::string& line) { return line.substr(0, line.find('#')); }

}  // namespace

std::vector<std::string> read_layers(std::string_view cmake_text) {
  constexpr std::string_view opening = "set(layers ";
  const auto begin = cmake_text.find(opening);
  if (begin == std::string_view::npos) return {};
  const std::string_view rest = cmake_text.substr(begin + opening.size());
  return words(rest.substr(0, rest.find(')')));
}

std::vector<std::string> read_table_layers(std::string_view markdown) {
  std::vector<std::string> result;
  bool inside = false;
  for (const std::string& line : lines(markdown)) {
    const auto row = words(line);
    const bool is_row = row.size() >= 3 && row[0] == "|" && row[2] == "|";
    if (is_row && row[1] == "layer")
      inside = true;
    else if (is_row && inside)
      result.push_back(row[1]);
    else if (row.empty())
      inside = false;
  }
  return result;
}

std::string layer_of(std::string_view path, const std::vector<std::string>& layers) {
  const auto slash = path.find('/');
  if (slash == std::string_view::npos) return "";
  const std::string_view first = path.substr(0, slash);
  return rank(first, layers) < layers.size() ? std::string(first) : "";
}

Findings check_includes(std::string_view path, std::string_view text, const std::vector<std::string>& layers) {
  const std::string own = layer_of(path, layers);
  if (own.empty()) return {std::string(path) + ": lies in no layer's folder"};
  Findings findings;
  std::size_t number = 0;
  for (const std::string& line : lines(text)) {
    ++number;
    const auto include = include_in(line);
    if (!include) continue;
    std::string wrong = check_fences(path, *include);
    const bool is_public = include->header.starts_with("kadans/");
    const std::string_view header = std::string_view(include->header).substr(is_public ? 7 : 0);
    if (is_public || (include->quoted && !layer_of(header, layers).empty())) wrong = check_layer(own, header, layers);
    if (include->header.find("..") != std::string::npos) wrong = "includes " + include->header + ", a path that climbs";
    if (!wrong.empty()) findings.push_back(place(path, number) + wrong);
  }
  return findings;
}

Findings check_public(std::string_view path, std::string_view text) {
  Findings findings;
  std::size_t number = 0;
  for (const std::string& line : lines(text)) {
    ++number;
    const auto include = include_in(line);
    if (include && include->quoted && !include->header.starts_with("kadans/"))
      findings.push_back(place(path, number) + "includes " + include->header + ", which is not installed");
  }
  return findings;
}

Findings check_links(std::string_view path, std::string_view cmake_text, const std::vector<std::string>& layers) {
  const std::string own = layer_of(path, layers);
  if (own.empty()) return {std::string(path) + ": lies in no layer's folder"};
  Findings findings;
  std::size_t number = 0;
  for (const std::string& whole : lines(cmake_text)) {
    ++number;
    for (const std::string& other : linked_in(without_comment(whole))) {
      const std::size_t other_rank = rank(other, layers);
      if (other_rank >= layers.size() || other_rank <= rank(own, layers)) continue;
      findings.push_back(
          place(path, number).append(own).append(" links ").append(other).append(", which stands below it"));
    }
  }
  return findings;
}

Findings check_length(std::string_view path, std::string_view text) {
  const auto count = static_cast<std::size_t>(std::ranges::count(text, '\n'));
  const std::size_t most = path.starts_with("src/") && path.ends_with(".cpp") ? max_source_lines : max_lines;
  if (count <= most) return {};
  return {std::string(path) + ": has " + std::to_string(count) + " lines; " + std::to_string(most) + " is the most"};
}

Findings check_name(std::string_view path) {
  static constexpr std::array<std::string_view, 9> banned{"util",    "utils", "utilities", "common",  "helper",
                                                          "helpers", "misc",  "manager",   "managers"};
  std::string spaced(path);
  std::ranges::replace_if(
      spaced, [](char c) { return c == '/' || c == '_' || c == '-' || c == '.'; }, ' ');
  for (const std::string& word : words(spaced)) {
    if (std::ranges::find(banned, word) != banned.end())
      return {std::string(path) + ": '" + word + "' says nothing; name it after what it holds"};
  }
  return {};
}

Findings check_writing(std::string_view path, std::string_view text) {
  // Files of the kernel, of the test kit, of a folder that is thrown away, lines that flow; and where JSON is bounded.
  static constexpr std::array<std::string_view, 6> free{
      "realtime/machine/placement.cpp", "realtime/machine/machine_load.cpp",
      "testing/golden_record.cpp",      "app/sim/input_files.cpp",
      "app/log/log_output.cpp",         "config/json/foreign_json.cpp"};
  if (std::ranges::find(free, path) != free.end()) return {};
  Findings findings;
  std::size_t number = 0;
  for (const std::string& line : lines(text)) {
    ++number;
    const bool opens = line.find("std::ofstream") != std::string::npos ||
                       (line.find("fopen(") != std::string::npos && line.find(", \"w") != std::string::npos);
    if (opens) findings.push_back(place(path, number) + "opens a file to write: write_durably tells what goes wrong");
    const auto dump = line.find(".dump(");
    const bool of_flight = dump != std::string::npos && dump >= 6 && line.compare(dump - 6, 6, "flight") == 0;
    if (dump != std::string::npos && !of_flight && line.find("error_handler_t") == std::string::npos)
      findings.push_back(place(path, number) + "dumps JSON that may hold foreign bytes: json_text takes them");
    if (line.find("son::parse(") != std::string::npos)
      findings.push_back(place(path, number) + "parses JSON without bounds: parse_foreign_json has them");
  }
  return findings;
}

std::vector<std::string> types_defined_in(std::string_view text) {
  std::vector<std::string> found, scopes;  // scopes: of namespaces, "" for one without a name
  const std::vector<std::string> all = lines(text);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& line = all[i];
    if (line.starts_with("namespace ") && line.ends_with("{")) scopes.push_back(words(line)[1]);
    if (line.starts_with("}  // namespace") && !scopes.empty()) scopes.pop_back();
    const bool defines = line.find('{') != std::string::npos ||
                         (line.find(';') == std::string::npos && i + 1 < all.size() && all[i + 1].starts_with("    :"));
    const bool is_type = line.starts_with("class ") || line.starts_with("struct ") || line.starts_with("enum class ");
    if (!is_type || !defines || std::ranges::find(scopes, "{") != scopes.end()) continue;
    if (i > 0 && all[i - 1].starts_with("template")) continue;  // it may be a specialisation
    std::string name;
    for (const std::string& scope : scopes) name += scope + "::";
    std::vector<std::string> parts = words(line.substr(0, std::min(line.find(" : "), line.find('{'))));
    std::erase_if(parts, [](const std::string& word) { return word.starts_with("alignas") || word == "final"; });
    found.push_back(name + parts.back());
  }
  return found;
}

Findings check_test_names(std::string_view path, std::string_view text) {
  constexpr std::string_view opening = "TEST_CASE(\"";
  Findings findings;
  for (std::size_t at = text.find(opening); at != std::string_view::npos; at = text.find(opening, at + 1)) {
    const std::size_t begin = at + opening.size();
    const std::string_view name = text.substr(begin, text.find('"', begin) - begin);
    if (name.find_first_of("[];") != std::string_view::npos) {
      findings.push_back(std::string(path) + ": the name of test \"" + std::string(name) + "\" holds one of [ ] ;");
    }
  }
  return findings;
}

Findings check_words(std::string_view path, std::string_view text) {
  const auto in_one_of = [path](std::initializer_list<std::string_view> folders) {
    return std::ranges::any_of(folders, [path](std::string_view folder) { return path.starts_with(folder); });
  };
  Findings findings;
  for (const std::string& type : types_defined_in(text)) {
    const std::string_view name = std::string_view(type).substr(type.rfind(':') + 1);
    const auto begins = [name](std::string_view word) { return name.starts_with(word); };
    std::string wrong;
    if (begins("Live") && !in_one_of({"remote/page/", "app/live/", "app/services.h"}))
      wrong = "'Live' is the server for viewers";
    if (name.ends_with("Place") && name != "TextPlace" && name != "ScriptPlace" && name != "SourcePlace")
      wrong = "a 'Place' is one in a text";
    if ((begins("Tune") || begins("Tuning")) && !in_one_of({"campaign/", "config/plan/", "app/tune/", "app/sweep/"}))
      wrong = "'tuning' searches for parameters";
    const auto speaks_of = [name](std::string_view word) {  // "OrderInfo", "DriveOrder"; not "Recorder", not "Placed"
      const std::size_t at = name.find(word);
      return at != std::string_view::npos && (at + word.size() == name.size() || std::isupper(name[at + word.size()]) ||
                                              name.substr(at + word.size()) == "s");
    };
    if (speaks_of("Order") && name != "DriveOrder" &&
        !in_one_of({"remote/", "config/scenario/play_item.h", "script/host/"}))
      wrong = "an 'order' is asked of a running instance";
    if (speaks_of("Request") && name != "DriveRequest" && !in_one_of({"remote/", "script/process/"}))
      wrong = "a 'request' is an order that is not read yet";
    if (speaks_of("Command") && !in_one_of({"signal/command.h", "engine/", "app/command"}))
      wrong = "a 'command' goes to the control engine, or stands on the command line";
    if (speaks_of("Log") && in_one_of({"telemetry/mcap/", "telemetry/reading/", "telemetry/plot/"}))
      wrong = "a 'log' is of lines, a run's file is a record";
    if (!wrong.empty())
      findings.push_back(std::string(path) + ": " + type + ": " + wrong + " (docs/architecture.md, words)");
  }
  return findings;
}

}  // namespace kadans::layout
