#include "source_text.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "signal/utf8.h"

namespace kadans {
namespace {

bool control(char c) noexcept {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20U && c != '\t' && c != '\n' && c != '\r') || byte == 0x7FU;
}

std::string hex(char c) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "0x%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return text.data();
}

}  // namespace

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
  std::string result(text.substr(0, size));
  for (char& c : result) {
    if (control(c) || c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return size < text.size() ? result + "..." : result;
}

}  // namespace kadans
