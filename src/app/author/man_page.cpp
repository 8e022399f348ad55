#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>
#include <vector>

#include "app/command_line.h"
#include "reference_pages.h"
#include "version.h"

namespace kadans {
namespace {

// As --help words it, but with the range after the name of the value.
std::string option_words(const CLI::Option& option) {
  const CLI::Formatter formatter;
  const bool positional = option.get_positional();
  std::string words = formatter.make_option_name(&option, positional) + formatter.make_option_opts(&option);
  std::replace(words.begin(), words.end(), '\n', ' ');
  return words;
}

std::vector<const CLI::Option*> options_of(const CLI::App& command, bool positional) {
  return command.get_options([&](const CLI::Option* option) {
    return option->get_positional() == positional && !option->get_group().empty() && option != command.get_help_ptr();
  });
}

std::string usage_of(const CLI::App& command, const std::string& words) {
  const std::string usage = CLI::Formatter().make_usage(&command, words);
  const std::size_t start = usage.find(words);
  return usage.substr(start, usage.find_last_not_of(" \n") + 1 - start);
}

struct Footer {
  std::string examples, notes;
};

// Examples are the indented lines after their heading; all else is for people.
Footer footer_of(const CLI::App& command) {
  Footer footer;
  std::istringstream lines(command.get_footer());
  for (std::string line; std::getline(lines, line);) {
    if (line == "Examples:") continue;
    (line.starts_with("  ") ? footer.examples : footer.notes) += line + "\n";
  }
  const std::size_t start = footer.notes.find_first_not_of('\n');
  footer.notes = start == std::string::npos ? "" : footer.notes.substr(start);
  return footer;
}

// Text that roff would take for something else: escapes, dashes, a dot or an apostrophe at the start of a line.
std::string roff(const std::string& text) {
  constexpr std::pair<char, const char*> escapes[] = {{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                      {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}};
  std::string safe;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c == '.' || c == '\'') && (i == 0 || text[i - 1] == '\n')) safe += "\\&";
    const auto* const found = std::ranges::find(escapes, c, &std::pair<char, const char*>::first);
    safe += found == std::end(escapes) ? std::string(1, c) : found->second;
  }
  return safe;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string joined(std::string words, char by) {
  std::replace(words.begin(), words.end(), ' ', by);
  return words;
}

std::string roff_options(const CLI::App& command) {
  std::string text;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : options_of(command, positional))
      text += ".TP\n\\fB" + roff(option_words(*option)) + "\\fR\n" + roff(option->get_description()) + "\n";
  }
  return text;
}

std::string roff_examples(const std::string& examples) { return ".nf\n" + roff(examples) + ".fi\n"; }

// The verbs of a group, each with its options and examples.
std::string roff_verbs(const CLI::App& group, const std::string& words) {
  std::string text;
  for (const CLI::App* verb : visible_below(group)) {
    const std::string verb_words = words + " " + verb->get_name();
    if (!visible_below(*verb).empty()) {
      text += roff_verbs(*verb, verb_words);
      continue;
    }
    text +=
        ".SS " + roff(usage_of(*verb, verb_words)) + "\n" + roff(verb->get_description()) + "\n" + roff_options(*verb);
    const Footer footer = footer_of(*verb);
    if (!footer.examples.empty()) text += ".PP\nExamples:\n.PP\n" + roff_examples(footer.examples);
    if (!footer.notes.empty()) text += ".PP\n" + roff(footer.notes);
  }
  return text;
}

std::string roff_commands(const CLI::App& program, const std::string& words) {
  std::string text;
  for (const CLI::App* command : visible_below(program))
    text += ".TP\n\\fB" + roff(joined(words + " " + command->get_name(), '-')) + "\\fR(1)\n" +
            roff(command->get_description()) + "\n";
  return text;
}

void add_markdown(const CLI::App& command, const std::string& words, std::string& text) {
  text += "\n## " + words + "\n\n" + markdown_text(command.get_description()) + ".\n\n```text\n" +
          usage_of(command, words) + "\n```\n";
  std::string rows;
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : options_of(command, positional))
      rows += "| `" + joined(option_words(*option), ' ') + "` | " + markdown_text(option->get_description()) + " |\n";
  }
  if (!rows.empty()) text += "\n| argument or option | meaning |\n|---|---|\n" + rows;
  const Footer footer = footer_of(command);
  if (!footer.examples.empty()) text += "\n```sh\n" + footer.examples + "```\n";
  if (!footer.notes.empty()) text += "\n" + markdown_text(footer.notes);
  for (const CLI::App* verb : visible_below(command)) add_markdown(*verb, words + " " + verb->get_name(), text);
}

}  // namespace

std::string man_page(const CLI::App& command, const std::string& words) {
  const bool program = command.get_parent() == nullptr;
  std::string title = joined(words, '-');
  std::string about = program ? "scriptable control runtime for robots" : first_line(command.get_description());
  std::string text = ".\\\" Made from the program's own --help; do not edit.\n.TH ";
  std::string upper = title;
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  text += roff(upper) + " 1 \"\" \"kadans " + version + "\" \"Kadans\"\n.SH NAME\n" + roff(title) + " \\- " +
          roff(about) + "\n.SH SYNOPSIS\n\\fB" + roff(usage_of(command, words)) + "\\fR\n.SH DESCRIPTION\n" +
          roff(command.get_description()) + "\n";
  if (const std::string options = roff_options(command); !options.empty()) text += ".SH OPTIONS\n" + options;
  if (!visible_below(command).empty())
    text += ".SH COMMANDS\n" + (program ? roff_commands(command, words) : roff_verbs(command, words));
  const Footer footer = footer_of(command);
  if (!footer.examples.empty()) text += ".SH EXAMPLES\n" + roff_examples(footer.examples);
  if (!footer.notes.empty()) text += ".SH NOTES\n" + roff(footer.notes);
  return text + ".SH SEE ALSO\n" + (program ? "" : "\\fBkadans\\fR(1), ") +
         "the manual in /usr/share/doc/kadans\\-doc (package kadans\\-doc)\n";
}

std::string markdown_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string command_reference(const CLI::App& program) {
  std::string text = "# Reference of the command line\n\nGenerated from the program's own `--help`.\n";
  for (const CLI::App* command : visible_below(program)) add_markdown(*command, "kadans " + command->get_name(), text);
  return text;
}

}  // namespace kadans
