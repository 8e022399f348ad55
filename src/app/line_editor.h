// Reads lines from a terminal with editing, history and completion by libedit, while other work goes on between the
// keys. There is one terminal, so there may be only one editor at a time.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kadans {

class LineEditor {
 public:
  struct Completion {
    std::size_t begin = 0;  // where the word begins in the text
    std::vector<std::string> words;
  };
  using Complete = std::function<Completion(const std::string& text)>;

  // The history is kept in state_file("history") if that can be written.
  LineEditor(std::string prompt, Complete complete);
  ~LineEditor();
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  // Waits for keys, at most for `milliseconds`. Returns a line when one is complete.
  std::optional<std::string> poll(int milliseconds);
  bool ended() const noexcept { return ended_; }  // Ctrl-D on an empty line
  void prompt(const std::string& text);           // from the next line on
  // Prints above the line that is being typed.
  void print(const std::string& text);

 private:
  static void take_line(char* line);
  static char** match(const char* word, int begin, int end);
  static char* next_match(const char* word, int state);

  static LineEditor* current;
  std::string prompt_;
  std::filesystem::path history_file_;
  Complete complete_;
  std::optional<std::string> line_;
  std::vector<std::string> matches_;
  bool ended_ = false;
};

// The path for a file that is kept between runs: $XDG_STATE_HOME/kadans/NAME, or in ~/.local/state; "" when there is no
// home. Makes the folder; it does not check that the file can be written.
std::filesystem::path state_file(const std::string& name);

}  // namespace kadans
