// Quotes words, so that commands that are told to people work when they are pasted into a shell.
#pragma once

#include <string>
#include <vector>

namespace kadans {

// In single quotes.
inline std::string shell_quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// As it is, or in single quotes when the shell would give it another meaning.
inline std::string shell_word(const std::string& word) {
  const bool plain = word.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                         "_-+./,:=@%") == std::string::npos;
  return plain && !word.empty() ? word : shell_quoted(word);
}

// The words of a line that shell_word() has quoted.
inline std::vector<std::string> shell_words(const std::string& line) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\'') {
      quoted = !quoted;
    } else if (line[i] == ' ' && !quoted) {
      words.emplace_back();
    } else {
      words.back() += line[i] == '\\' && !quoted && i + 1 < line.size() ? line[++i] : line[i];
    }
  }
  return words;
}

}  // namespace kadans
