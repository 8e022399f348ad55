// `kadans completion`: the scripts by which shells complete the command line. Commands and options come from the
// program itself. Names of parameters, signals and behaviors come from the running instance at the time of completion.
#include <cstdio>
#include <sstream>
#include <string>

#include <CLI/CLI.hpp>

#include "app/author/reference_pages.h"
#include "app/commands.h"
#include "remote/order/order.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

struct CompletionOptions {
  std::string shell;  // "bash" or "zsh"
};

std::string subcommands_of(const CLI::App& app) {
  return listed(
      visible_below(app), [](const CLI::App* command) { return command->get_name(); }, " ");
}

std::string options_of(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options([](const CLI::Option* one) { return !one->get_lnames().empty(); })) {
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : " --") + name;
  }
  return names;
}

// One line of a case for each command with its path: "  'ctl fault') echo 'list clear';;".
void add_cases(const CLI::App& app, const std::string& path, bool options, std::string& text) {
  std::string words = options ? options_of(app) : subcommands_of(app);
  if (options && path.starts_with("ctl ")) words += " --socket --json";  // as for ctl itself, before or after the verb
  if (!words.empty()) text += "    '" + path + "') echo '" + words + "';;\n";
  for (const CLI::App* command : visible_below(app))
    add_cases(*command, path + (path.empty() ? "" : " ") + command->get_name(), options, text);
}

// The part that both shells understand. "$1" holds the commands typed so far; options for ctl follow. In zsh the name
// `path` is reserved for PATH.
std::string names_function() {
  std::string text = "\n_kadans_names() {\n  local at=$1\n  shift\n  case $at in\n";
  for (const OrderInfo& order : order_table::orders) {
    std::istringstream lists(order.arguments[0].lists);
    std::string lines;
    for (std::string what; lists >> what;) lines += " kadans ctl \"$@\" list " + what + " --names;";
    if (!lines.empty()) text += "    'ctl " + std::string(order.words) + "')" + lines + ";\n";
  }
  return text +
         "    'ctl list') echo 'behaviors sets objects parameters signals events';;\n    'completion') echo 'bash "
         "zsh';;\n"
         "  esac 2>/dev/null\n}\n";
}

// Goes through the words before the one that is completed. Collects the commands and the options that lead to the
// instance.
constexpr const char* walk = R"sh(
  local at= before= word= socket=
  for word in "${typed[@]}"; do
    if [[ $before == --socket ]]; then socket=$word
    elif [[ $word != -* && " $(_kadans_commands "$at") " == *" $word "* ]]; then at="$at${at:+ }$word"; fi
    before=$word
  done
  local -a to=()
  if [[ -n $socket ]]; then to=(--socket "$socket"); fi
  local choice=
  if [[ $current == -* ]]; then choice=$(_kadans_options "$at")
  elif [[ $before != --* || $before == --replace || $before == --json ]]; then choice="$(_kadans_commands "$at") $(_kadans_names "$at" "${to[@]}")"; fi
)sh";

constexpr const char* bash_tail = R"sh(
  COMPREPLY=($(compgen -W "$choice" -- "$current"))
  if [[ ${#COMPREPLY[@]} -eq 0 && $current != -* ]]; then COMPREPLY=($(compgen -f -- "$current")); fi
}
complete -o filenames -F _kadans kadans
)sh";

constexpr const char* zsh_tail = R"sh(
  local -a choices
  choices=(${=choice})
  if (( ${#choices} )); then compadd -- "${choices[@]}"; else _files; fi
}
if [[ $funcstack[1] == _kadans ]]; then _kadans "$@"; elif (( $+functions[compdef] )); then compdef _kadans kadans; fi
)sh";

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  const bool bash = shell == "bash";
  std::string text = bash ? "" : "#compdef kadans\n";
  text += "# Completion for kadans, made by 'kadans completion " + shell + "'.\n";
  text += "_kadans_commands() {\n  case $1 in\n";
  add_cases(app, "", false, text);
  text += "  esac\n}\n\n_kadans_options() {\n  case $1 in\n";
  add_cases(app, "", true, text);
  text += "  esac\n}\n";
  text += names_function();
  text += bash ? "\n_kadans() {\n  local current=${COMP_WORDS[COMP_CWORD]}\n"
                 "  local -a typed=(\"${COMP_WORDS[@]:1:COMP_CWORD-1}\")"
               : "\n_kadans() {\n  local current=${words[CURRENT]}\n"
                 "  local -a typed=(\"${(@)words[2,CURRENT-1]}\")";
  text += walk;
  text += bash ? bash_tail : zsh_tail;
  return text;
}

namespace {

int run_completion(const CommandLine& line, const CompletionOptions& options) {
  std::fputs(completion_script(line.app, options.shell).c_str(), stdout);
  return 0;
}

}  // namespace

void add_completion(CommandLine& line) {
  const auto [completion, options] =
      line.add<CompletionOptions>("completion", "Print the completion script of a shell", run_completion);
  completion->add_option("shell", options.shell, "bash or zsh")->required()->check(CLI::IsMember({"bash", "zsh"}));
}

}  // namespace kadans
