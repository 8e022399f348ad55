#include "line_editor.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <editline/readline.h>
#include <poll.h>
#include <unistd.h>

#include "config/robot/project_root.h"
#include "terminal.h"

namespace kadans {
namespace {

constexpr int history_lines = 1000;

}  // namespace

LineEditor* LineEditor::current = nullptr;

LineEditor::LineEditor(std::string prompt, Complete complete)
    : prompt_(std::move(prompt)), history_file_(state_file("history")), complete_(std::move(complete)) {
  current = this;
  using_history();
  stifle_history(history_lines);
  if (!history_file_.empty()) (void)read_history(history_file_.c_str());
  static char breaks[] = " \t\n\"'`@$><=;|&{}()+-*/,~#%^[]";
  rl_completer_word_break_characters = breaks;
  rl_attempted_completion_function = match;
  rl_completion_append_character = '\0';
  rl_callback_handler_install(prompt_.c_str(), take_line);
}

LineEditor::~LineEditor() {
  rl_callback_handler_remove();
  if (!history_file_.empty()) (void)write_history(history_file_.c_str());
  current = nullptr;
}

std::optional<std::string> LineEditor::poll(int milliseconds) {
  pollfd keys{STDIN_FILENO, POLLIN, 0};
  if (::poll(&keys, 1, milliseconds) > 0) rl_callback_read_char();
  std::optional<std::string> line;
  line.swap(line_);
  return line;
}

void LineEditor::prompt(const std::string& text) {
  if (text == prompt_) return;
  prompt_ = text;
  rl_callback_handler_remove();
  rl_callback_handler_install(prompt_.c_str(), take_line);
}

void LineEditor::print(const std::string& text) {
  std::fputs("\r\033[K", stdout);
  print_text(text + "\n");
  std::fflush(stdout);
  rl_forced_update_display();
}

void LineEditor::take_line(char* line) {
  if (line == nullptr) {
    current->ended_ = true;
    return;
  }
  if (*line != '\0') add_history(line);
  current->line_ = line;
  std::free(line);  // NOLINT: libedit allocates it by malloc
}

char** LineEditor::match(const char* word, int /*begin*/, int end) {
  const std::string text(rl_line_buffer, static_cast<std::size_t>(end));
  Completion found = current->complete_(text);
  // libedit replaces its own word, which may begin earlier or later than ours.
  const std::size_t begin = text.size() - std::strlen(word);
  current->matches_.clear();
  for (const std::string& whole : found.words) {
    const std::string replaced = text.substr(0, found.begin) + whole;
    if (replaced.size() >= begin) current->matches_.push_back(replaced.substr(begin));
  }
  rl_attempted_completion_over = 1;  // no file names
  return current->matches_.empty() ? nullptr : rl_completion_matches(word, next_match);
}

char* LineEditor::next_match(const char* /*word*/, int state) {
  static std::size_t next = 0;
  if (state == 0) next = 0;
  return next < current->matches_.size() ? strdup(current->matches_[next++].c_str()) : nullptr;
}

std::filesystem::path state_file(const std::string& name) {
  const std::filesystem::path folder = user_folder("XDG_STATE_HOME", ".local/state");
  if (folder.empty()) return {};
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  return folder / name;
}

}  // namespace kadans
