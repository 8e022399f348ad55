// Quotes words, so that commands that are told to people work when they are pasted into a shell.
#pragma once

#include <string>

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

}  // namespace kadans
