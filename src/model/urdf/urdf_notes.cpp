#include "urdf_notes.h"

#include <algorithm>
#include <tuple>

namespace kadans {
namespace {

// " (40 such: also in lines 12, 19, 31 ...)" for further places.
std::string further(const std::vector<std::size_t>& places, const SourceText& source) {
  constexpr std::size_t most_lines = 3;
  if (places.size() < 2) return {};
  std::vector<int> lines;
  for (const std::size_t at : places) lines.push_back(source.place(at).line);
  std::ranges::sort(lines);
  const int first = lines.front();
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  lines.erase(std::ranges::find(lines, first));
  std::string text = " (" + std::to_string(places.size()) + " such";
  if (lines.empty()) return text + " in this line)";
  text += lines.size() == 1 ? ": also in line " : ": also in lines ";
  for (std::size_t i = 0; i < std::min(lines.size(), most_lines); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(lines[i]);
  return text + (lines.size() > most_lines ? " ...)" : ")");
}

}  // namespace

void UrdfNotes::add(std::size_t at, std::string message, std::string_view kind) {
  auto found = kinds_.find(kind.empty() ? std::string_view(message) : kind);
  if (found == kinds_.end() && full()) {
    ++left_out_;
    return;
  }
  if (found == kinds_.end()) found = kinds_.emplace(kind.empty() ? message : std::string(kind), Kind{}).first;
  Kind& to = found->second;
  if (to.places.empty() || at < to.first) to.message = std::move(message), to.first = at;
  to.places.push_back(at);
}

std::vector<InputProblem> UrdfNotes::told(const std::string& file, const SourceText& source) const {
  std::vector<InputProblem> problems;
  for (const auto& [kind, of] : kinds_) {
    const TextPlace place = source.place(of.first);
    problems.push_back({file, place.line, place.column, of.message + further(of.places, source)});
  }
  sort_by_place(problems);
  if (left_out_ > 0) problems.push_back({file, 0, 0, "and " + std::to_string(left_out_) + " more of other kinds"});
  return problems;
}

void sort_by_place(std::vector<InputProblem>& problems) {
  std::ranges::stable_sort(problems, [](const InputProblem& a, const InputProblem& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
}

}  // namespace kadans
