#include "commission_person.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "app/terminal.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

void show_question(const Question& question) {
  print_text(question.text + (question.answers.empty() ? "" : " [" + listed(question.answers) + "]") + "\n");
  std::fflush(stdout);
}

}  // namespace

void TerminalPerson::hear(const std::string& sentence) {
  print_text(sentence + "\n");
  std::fflush(stdout);
}

void TerminalPerson::ask(const Question& question) {
  line_.clear();
  show_question(question);
}

void TerminalPerson::ask_to_hold(const Question& question) {
  told_complete_ = false;
  until_ns_ = 0;
  hear(question.text);
  hear("  Hold the space bar. Enter: seen. q: end.");
}

std::optional<std::string> TerminalPerson::answer(std::int64_t) {
  for (const char c : keys_.pressed(gone_)) {
    if (c == '\n' || c == '\r') {
      print_text("\n");
      return line_;
    }
    if (c == 0x7f || c == '\b') {
      if (!line_.empty()) {
        line_.pop_back();
        std::fputs("\b \b", stdout);
      }
    } else {
      line_ += c;
      print_text(std::string(1, c));
    }
    std::fflush(stdout);
  }
  return std::nullopt;
}

Person::Hand TerminalPerson::hand(std::int64_t now_ns, bool complete) {
  if (complete && !told_complete_) hear("  That was all. Enter: go on.");
  told_complete_ = complete;
  for (const char c : keys_.pressed(gone_)) {
    if (c == '\n' || c == '\r') return Hand::done;
    if (c == 'q') gone_ = true;
    until_ns_ = now_ns + hold_ns;
  }
  return now_ns < until_ns_ && !gone_ ? Hand::holds : Hand::away;
}

bool TerminalPerson::gone() { return gone_ || interrupted(); }

WrittenPerson::WrittenPerson(const std::string& file) {
  if (file.empty()) {
    keys_ = std::make_unique<Keys>();
  } else {
    take(read_input_file(file) + "\n");
  }
}

void WrittenPerson::take(std::string_view text) {
  for (const char c : text) {
    if (c != '\n') {
      begun_ += c;
      continue;
    }
    while (!begun_.empty() && (begun_.back() == ' ' || begun_.back() == '\r')) begun_.pop_back();
    if (!begun_.empty() && begun_.front() != '#') lines_.push_back(begun_);
    begun_.clear();
  }
}

std::optional<std::string> WrittenPerson::next() {
  if (lines_.empty()) return std::nullopt;
  std::string line = lines_.front();
  lines_.pop_front();
  print_text("> " + line + "\n");
  return line;
}

void WrittenPerson::hear(const std::string& sentence) { print_text(sentence + "\n"); }

void WrittenPerson::ask(const Question& question) {
  show_question(question);
  asked_ = true;
}

void WrittenPerson::ask_to_hold(const Question& question) {
  hear(question.text);
  asked_ = true;
  held_from_ns_.reset();
}

std::optional<std::string> WrittenPerson::answer(std::int64_t) {
  const std::optional<std::string> line = next();
  if (line) asked_ = false;
  return line;
}

Person::Hand WrittenPerson::hand(std::int64_t now_ns, bool complete) {
  if (!held_from_ns_) {
    const std::optional<std::string> line = next();
    if (!line) return Hand::away;
    char* end = nullptr;
    holds_s_ = *line == "hold" ? std::numeric_limits<double>::infinity() : std::strtod(line->c_str() + 5, &end);
    if (!line->starts_with("hold") || (end != nullptr && *end != '\0') || !(holds_s_ >= 0))
      refuse("--answers", "'" + *line + "' is no answer here: 'hold' or 'hold S'");
    held_from_ns_ = now_ns;
    asked_ = false;
  }
  if (complete || 1e-9 * static_cast<double>(now_ns - *held_from_ns_) >= holds_s_) return Hand::done;
  return Hand::holds;
}

bool WrittenPerson::gone() {
  if (keys_) {
    bool end = false;
    take(keys_->pressed(end));
    lines_end_ = lines_end_ || end;
  }
  const bool nothing_comes = !keys_ || lines_end_;
  return interrupted() || (asked_ && lines_.empty() && nothing_comes);
}

}  // namespace kadans
