#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "check_source.h"

namespace kadans {
namespace {

// The letters of the places in a format: "%5.2f m, %s" has "fs". '?' stands for one that Lua does not know.
std::string places_of(std::string_view format) {
  constexpr std::string_view known = "aAcdeEfgGioqsuxXp";
  std::string letters;
  for (std::size_t at = format.find('%'); at != std::string_view::npos; at = format.find('%', at)) {
    at = std::min(format.find_first_not_of("-+ #0123456789.", at + 1), format.size());
    if (at < format.size() && format[at] == '%' && format[at - 1] == '%') {
      ++at;
      continue;
    }
    const bool there = at < format.size() && known.find(format[at]) != std::string_view::npos;
    letters += there ? format[at] : '?';
  }
  return letters;
}

// Whether how many values it gives is known only in the run: f(x), `...`.
bool gives_many(const Tokens& tokens, std::size_t end) {
  return tokens[end - 1].is(")") || tokens[end - 1].is("...") || tokens[end - 1].is("}") ||
         tokens[end - 1].kind == TokenKind::text;
}

bool no_number(const Tokens& tokens, std::size_t at) {
  const SourceToken& after = tokens[at + 1];
  if (!after.is(",") && !after.is(")")) return false;
  if (tokens[at].is("nil") || tokens[at].is("true") || tokens[at].is("false")) return true;
  if (tokens[at].kind != TokenKind::text) return false;
  char* end = nullptr;
  (void)std::strtod(tokens[at].text.c_str(), &end);
  return *end != '\0' || tokens[at].text.empty();
}

std::string count_text(std::size_t count) {
  return count == 0 ? "no value" : count == 1 ? "1 value" : std::to_string(count) + " values";
}

}  // namespace

std::string format_mistake(const Tokens& tokens, std::size_t at, const std::string& called) {
  if (at == 0 || !tokens[at - 1].is("(") || tokens[at].kind != TokenKind::text) return "";
  if (!tokens[at + 1].is(",") && !tokens[at + 1].is(")")) return "";
  const std::vector<std::size_t> given = parts_of(tokens, at);
  const std::string places = places_of(tokens[at].text);
  const bool alone = given.size() == 1;
  if (alone && called != "string.format") return "";  // a text as it is
  if (places.find('?') != std::string::npos)
    return called + ": the format has a '%' that Lua does not know; %% is a percent sign";
  const std::size_t values = given.size() - 1;
  const std::size_t end = end_of_call(tokens, at) - 1;
  const bool many =
      !alone && gives_many(tokens, end) && !(tokens[given.back()].kind == TokenKind::text && given.back() + 1 == end);
  if (values < places.size() && !many)
    return called + ": the format wants " + count_text(places.size()) + ", " + count_text(values) + " is given";
  if (values > places.size())
    return called + ": the format has places for " + count_text(places.size()) + ", " + count_text(values) +
           " is given";
  for (std::size_t i = 0; i < values && i < places.size(); ++i) {
    const bool number = places[i] != 's' && places[i] != 'q' && places[i] != 'p';
    if (number && no_number(tokens, given[i + 1]))
      return called + ": %" + places[i] + " wants a number, value " + std::to_string(i + 1) + " is none";
  }
  return "";
}

std::string print_mistake(const Tokens& tokens, std::size_t at) {
  if (at == 0 || !tokens[at - 1].is("(") || tokens[at].kind != TokenKind::text || !tokens[at + 1].is(",")) return "";
  const std::string places = places_of(tokens[at].text);
  if (places.empty() || places.find('?') != std::string::npos) return "";
  return "print writes its values as they are: k.log.info(\"...\", ...) takes a format";
}

}  // namespace kadans
