#include "ctl_console.h"

#include <cstdio>
#include <iostream>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/line_editor.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

constexpr int answer_ms = 15'000;
constexpr int keys_ms = 100;

Json ask(CtlLink& link, const char* verb, const std::string& text) {
  link.send(json_text(Json{{"verb", verb}, {"text", text}}));
  const std::optional<std::string> line = link.receive(answer_ms);
  if (!line) throw InputError({.message = "the instance does not answer"});
  return parse_foreign_json(*line);
}

int from_pipe(CtlLink& link) {
  int code = exit_passed;
  for (std::string line; std::getline(std::cin, line);) {
    const Json answer = ask(link, "line", line);
    if (answer.value("ok", false)) {
      const std::string text = answer.at("text");
      if (!text.empty()) std::puts(text.c_str());
    } else {
      code = exit_failed;
      print_error(answer.at("error"));
    }
    std::fflush(stdout);
    if (answer.value("leaves", false) || interrupted()) break;
  }
  return code;
}

int from_terminal(CtlLink& link) {
  catch_interrupts();
  std::puts(":help tells what can be typed; :quit leaves, the instance goes on");
  LineEditor editor("kadans> ", state_file("history"), [&link](const std::string& text) {
    const Json answer = ask(link, "complete", text);
    if (!answer.value("ok", false)) return LineEditor::Completion{};
    return LineEditor::Completion{answer.at("begin"), answer.at("words")};
  });
  while (!editor.ended() && !interrupted()) {
    const std::optional<std::string> line = editor.poll(keys_ms);
    if (!line) continue;
    const Json answer = ask(link, "line", *line);
    const bool good = answer.value("ok", false);
    const std::string text = good ? answer.at("text") : answer.at("error");
    if (!text.empty()) editor.print(good ? text : "error: " + text);
    if (answer.value("leaves", false)) break;
    editor.prompt(answer.value("incomplete", false) ? "   ... "
                  : answer.value("writes", false)   ? "kadans! "
                                                    : "kadans> ");
  }
  std::puts("");
  return exit_passed;
}

}  // namespace

int ctl_console(CtlLink& link) { return isatty(STDIN_FILENO) == 1 ? from_terminal(link) : from_pipe(link); }

}  // namespace kadans
