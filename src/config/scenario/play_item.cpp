#include "play_item.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include "config/robot/project_root.h"
#include "event_text.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

struct Mistake {
  std::size_t at;
  std::string message;
};

struct WrittenItem {
  std::string behavior;
  std::size_t at = 0;
  std::uint32_t lane = 0;
  std::vector<std::pair<PlayArgument, std::size_t>> arguments;
};

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool continues_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

class PlayText {
 public:
  explicit PlayText(std::string_view text, std::size_t arguments_max = SIZE_MAX)
      : text_(text), arguments_max_(arguments_max) {}

  // Throws Mistake.
  std::vector<WrittenItem> read() {
    std::vector<WrittenItem> items;
    std::uint32_t lane = 0;
    do {
      do {
        items.push_back(item(lane));
      } while (take(','));
      ++lane;
    } while (take('|'));
    skip_space();
    if (at_ < text_.size()) wanted("a comma, or '{' and arguments");
    return items;
  }

 private:
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }
  bool take(char c) {
    skip_space();
    if (next() != c || at_ == text_.size()) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void wanted(const std::string& what) {
    skip_space();
    const std::string seen = at_ < text_.size() ? in_quotes(text_.substr(at_, 1)) : std::string("the end");
    throw Mistake{at_, "wanted " + what + ", found " + seen};
  }

  WrittenItem item(std::uint32_t lane) {
    skip_space();
    WrittenItem made{.behavior = {}, .at = at_, .lane = lane, .arguments = {}};
    const auto ends = [](char c) {
      return is_space(c) || std::string_view(",|{}='\"").find(c) != std::string_view::npos;
    };
    while (at_ < text_.size() && !ends(text_[at_])) made.behavior += text_[at_++];
    if (made.behavior.empty()) wanted("the name of a behavior");
    if (!take('{') || take('}')) return made;
    do {
      add_argument(made);
    } while (take(','));
    if (!take('}')) wanted("a comma or '}'");
    return made;
  }

  void add_argument(WrittenItem& item) {
    skip_space();
    const std::size_t begin = at_;
    if (item.arguments.size() == arguments_max_)
      throw Mistake{begin, "there are more than " + std::to_string(arguments_max_)};
    PlayArgument argument;
    while (continues_name(next())) argument.name += text_[at_++];
    if (argument.name.empty() || std::isdigit(static_cast<unsigned char>(argument.name[0])) != 0)
      throw Mistake{begin, "wanted the name of an argument"};
    for (const auto& [earlier, place] : item.arguments) {
      if (earlier.name == argument.name) throw Mistake{begin, "argument " + in_quotes(argument.name) + " stands twice"};
    }
    if (!take('=')) wanted("'=' and a value");
    argument.value = value();
    item.arguments.emplace_back(std::move(argument), begin);
  }

  PlayValue value() {
    skip_space();
    if (next() == '\'' || next() == '"') return text();
    const std::size_t begin = at_;
    std::string word;
    while (at_ < text_.size() &&
           (continues_name(text_[at_]) || std::string_view("+-.").find(text_[at_]) != std::string_view::npos))
      word += text_[at_++];
    if (word == "true" || word == "false") return word == "true";
    const std::string wanted_value = "wanted a number, true, false or a text in quotes";
    if (word.empty()) throw Mistake{begin, wanted_value};
    const bool number_like =
        std::isalpha(static_cast<unsigned char>(word[0])) == 0 && word.find_first_of("xXpP") == std::string::npos;
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (!number_like || *end != '\0' || !std::isfinite(number))
      throw Mistake{begin, wanted_value + ", found " + in_quotes(word)};
    return number;
  }

  std::string text() {
    const std::size_t begin = at_;
    const char quote = text_[at_++];
    const std::size_t end = text_.find(quote, at_);
    if (end == std::string_view::npos) throw Mistake{begin, "this text has no end"};
    std::string made(text_.substr(at_, end - at_));
    at_ = end + 1;
    return made;
  }

  std::string_view text_;
  std::size_t arguments_max_;
  std::size_t at_ = 0;
};

bool is_path(const std::string& behavior) {
  return behavior.find('/') != std::string::npos || behavior.ends_with(".lua") ||
         behavior.find('.') != std::string::npos;
}

fs::path folder_of(const PlayFolders& folders) {
  return project_root(folders.project_file) / "behaviors" / folders.robot;
}

fs::path find_by_path(const std::string& path, TextPlace place, const PlayFolders& folders, Problems& problems) {
  Problems own(folders.project_file.string());
  fs::path file = resolve_file(path, place, "behavior", own);
  try {
    own.throw_if_any();
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) problems.add(place, problem.message);
  }
  return file;
}

fs::path find_by_name(const std::string& name, TextPlace place, const PlayFolders& folders, Problems& problems) {
  fs::path file = folder_of(folders) / (name + ".lua");
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored)) return file;
  problems.add_unknown(place, "behavior", name, playable_names(folders), "in behaviors/" + folders.robot);
  return {};
}

}  // namespace

std::vector<PlayArgument> read_play_arguments(std::string_view text, std::size_t count_max, const std::string& source) {
  constexpr std::string_view head = "x{";
  const std::string whole = std::string(head) + std::string(text) + "}";
  std::vector<PlayArgument> arguments;
  try {
    const std::vector<WrittenItem> items = PlayText(whole, count_max).read();
    if (items.size() != 1) throw Mistake{head.size(), "wanted name=value,name=value"};
    for (const auto& [argument, at] : items.front().arguments) arguments.push_back(argument);
  } catch (const Mistake& mistake) {
    refuse(source, mistake.message);
  }
  return arguments;
}

std::vector<std::string> playable_names(const PlayFolders& folders) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(folders), ignored)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".lua" && !name.ends_with("_test")) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

std::vector<PlayItem> read_play_items(std::string_view text, TextPlace start, const PlayFolders& folders,
                                      Problems& problems) {
  const auto place_of = [&](std::size_t at) {
    return TextPlace{start.line,
                     start.column + static_cast<int>(std::ranges::count(text.substr(0, at), false, inside_character))};
  };
  std::vector<PlayItem> items;
  try {
    for (WrittenItem& written : PlayText(text).read()) {
      const TextPlace place = place_of(written.at);
      PlayItem item{.file = {}, .lane = written.lane, .source = problems.file(), .place = place};
      item.file = is_path(written.behavior) ? find_by_path(written.behavior, place, folders, problems)
                                            : find_by_name(written.behavior, place, folders, problems);
      for (auto& [argument, at] : written.arguments) {
        argument.place = place_of(at);
        item.arguments.push_back(std::move(argument));
      }
      if (const std::string why = out_of_bounds(item.arguments); !why.empty())
        problems.add(place, "what to play: " + why);
      items.push_back(std::move(item));
    }
  } catch (const Mistake& mistake) {
    problems.add(place_of(mistake.at), "what to play: " + mistake.message);
  }
  return items;
}

std::vector<PlayItem> read_play_items(std::string_view text, const std::string& source, const PlayFolders& folders) {
  Problems problems(source);
  std::vector<PlayItem> items = read_play_items(text, TextPlace{1, 1}, folders, problems);
  problems.throw_if_any();
  return items;
}

}  // namespace kadans
