// `kadans ctl`: sends an order to a running instance, and prints its answer for people.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/commands.h"
#include "app/line_editor.h"
#include "app/option_checks.h"
#include "app/push/remote_host.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "remote/ctl/ctl_folder.h"
#include "remote/order/order.h"
#include "remote/order/order_json.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

// `kadans ctl`: talks to a running instance.
struct CtlOptions {
  std::string socket;  // "": the usual places
  std::string host;    // "": this computer
  bool json = false;
  bool names = false;                                                               // list only the names
  std::optional<long> count;                                                        // of samples; nullopt: until Ctrl-C
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> given{};  // by verb and argument
};

constexpr std::size_t column_max = 48;

std::string number(const Json& value) { return value.is_number() ? printed("%.6g", value.get<double>()) : "nan"; }

std::string joined(const Json& texts) {
  return listed(texts, [](const Json& text) { return text.get<std::string>(); });
}

// Rows of cells, each column as wide as its widest.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i + 1 < row.size(); ++i)
      widths[i] = std::max(widths[i], std::min(row[i].size(), column_max));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line.append(std::max(row[i].size(), widths[i]) - row[i].size() + 2, ' ');
    }
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string behavior_text(const Json& behavior) {
  const std::string name = behavior.at("name");
  if (behavior.contains("error")) return name + ": " + behavior.at("error").get<std::string>();
  if (behavior.contains("outcome"))
    return name + ": " + behavior.at("outcome").get<std::string>() +
           (behavior.contains("result") ? " " + behavior.at("result").get<std::string>() : "");
  if (!behavior.value("plays", false)) return name + ": stopped";
  return name + (behavior.contains("active") ? " in " + joined(behavior.at("active")) : " waits");
}

std::string status_text(const Json& answer) {
  const std::string head = printed("%.2f s, tick %lld", answer.at("time_s").get<double>(),
                                   static_cast<long long>(answer.at("tick").get<std::int64_t>()));
  std::string text = answer.at("name").get<std::string>() + " (" + answer.at("mode").get<std::string>() + ", process " +
                     std::to_string(answer.at("pid").get<int>()) + "): " + head + "\n";
  const Json& safety = answer.at("safety");
  text += "  safety   " + safety.at("level").get<std::string>();
  if (safety.contains("first"))
    text += ", " + std::to_string(safety.at("faults").get<std::uint32_t>()) + " faults, first " +
            safety.at("first").at("text").get<std::string>();
  text += "\n  sets     " + joined(answer.at("control_sets")) + "\n  plays    ";
  std::string playing = answer.value("behaviors_error", std::string());
  for (const Json& behavior : answer.value("behaviors", Json::array()))
    playing += (playing.empty() ? "" : "; ") + behavior_text(behavior);
  text += (answer.value("paused", false) ? "paused; " : "") + (playing.empty() ? "nothing" : playing) + "\n";
  const Json& record = answer.at("record");
  if (record.is_null()) return text + "  record   none\n";
  return text + "  record   " + record.at("file").get<std::string>() + ", " +
         std::to_string(record.at("rows").get<std::uint64_t>()) + " rows, " +
         std::to_string(record.at("dropped").get<std::uint32_t>()) + " dropped" +
         (record.at("failed").get<bool>() ? ", the disk failed" : "") + "\n";
}

std::string range_text(const Json& item) {
  if (!item.contains("min") && !item.contains("max")) return "";
  return (item.contains("min") ? number(item.at("min")) : "") + ".." +
         (item.contains("max") ? number(item.at("max")) : "");
}

std::string list_text(const Json& items) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& item : items) {
    std::vector<std::string> row{item.at("name").get<std::string>()};
    if (item.contains("value")) row.push_back(number(item.at("value")));
    if (item.contains("unit")) row.push_back(item.at("unit"));
    if (item.contains("value")) row.push_back(range_text(item));
    if (item.contains("type")) row.push_back(item.at("type"));
    if (item.contains("joints")) row.push_back(joined(item.at("joints")));
    if (item.contains("objects")) row.push_back(joined(item.at("objects")));
    if (item.contains("objects")) row.emplace_back(item.value("active", false) ? "active" : "");
    if (item.contains("lane")) {
      const std::string told = behavior_text(item);
      row.push_back(told.substr(std::min(told.size(), told.find_first_not_of(": ", row.front().size()))));
    }
    if (item.contains("doc")) row.push_back(item.at("doc"));
    rows.push_back(std::move(row));
  }
  return table(rows);
}

std::string value_text(const Json& answer) {
  const std::string unit = answer.at("unit");
  return number(answer.at("value")) + (unit.empty() ? "" : " " + unit) + "\n";
}

std::string change_text(const Json& change) {
  return change.at("name").get<std::string>() + ": " + number(change.at("before")) + " -> " + number(change.at("now")) +
         "\n";
}

std::string fault_list(const Json& answer) {
  std::string text = "safety level " + answer.at("level").get<std::string>() + ", " +
                     std::to_string(answer.at("since_clearing").get<std::uint32_t>()) +
                     " faults since the last clearing\n";
  for (const Json& fault : answer.at("faults"))
    text += "  " + fault.at("text").get<std::string>() + " (tick " +
            std::to_string(fault.at("tick").get<std::uint64_t>()) + ", " +
            std::to_string(fault.at("count").get<std::uint32_t>()) + " times)\n";
  return text;
}

std::string drives_text(const Json& answer) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& drive : answer.at("drives")) {
    const bool warm = drive.at("temperature_C").is_number();
    const auto code = drive.at("code").get<std::uint32_t>();
    rows.push_back({drive.at("joint"), drive.at("state"), warm ? number(drive.at("temperature_C")) + " C" : "",
                    drive.at("homed").get<bool>() ? "" : "not homed", drive.at("braked").get<bool>() ? "braked" : "",
                    code == 0 ? "" : "code " + std::to_string(code)});
  }
  std::string text = table(rows);
  if (answer.at("supply_V").is_number()) text += "supply " + number(answer.at("supply_V")) + " V\n";
  return text + (answer.at("emergency").get<bool>() ? "the emergency stop's button is pressed\n" : "");
}

std::string world_text(const Json& answer) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& entry : answer.at("world")) {
    if (!entry.contains("fields")) {
      rows.push_back({entry.at("entry"), "nothing is known"});
      continue;
    }
    std::string fields;
    for (const auto& [name, value] : entry.at("fields").items())
      fields += (fields.empty() ? "" : ", ") + name + " " + number(value);
    rows.push_back({entry.at("entry"), fields, number(entry.at("age_s")) + " s old",
                    "confidence " + number(entry.at("confidence")), "from " + entry.at("source").get<std::string>(),
                    entry.at("carried").get<bool>() ? "" : "the way since is not known"});
  }
  return rows.empty() ? "the configuration names no entries (supervisor.world)\n" : table(rows);
}

// The parameters to which presets give other values, and how to change that.
std::string overridden_text(const Json& overridden) {
  std::string text, last;
  for (const Json& one : overridden) {
    const std::string name = one.at("name");
    text += (name == last ? ", " : (last.empty() ? "  " : "\n  ") + name + ": ") + one.at("preset").get<std::string>() +
            " sets " + number(one.at("value"));
    last = name;
  }
  return text.empty() ? ""
                      : "where a behavior chooses a preset, that counts, in the next run too:\n" + text +
                            "\n'kadans ctl save --preset NAME' writes what was set into one of them, too\n";
}

std::string save_text(const Json& answer) {
  if (!answer.contains("overridden")) return "nothing was changed\n";
  std::string text;
  for (const Json& change : answer.at("saved")) text += change_text(change);
  text += "saved in " + answer.at("file").get<std::string>();
  if (answer.contains("preset")) text += ", also in preset " + answer.at("preset").get<std::string>();
  return text + "\n" + overridden_text(answer.at("overridden"));
}

// `words` is the verb on the command line, such as "record stop". The text ends with a newline, or is empty.
std::string answer_text(const std::string& words, const Json& answer) {
  if (words == "status") return status_text(answer);
  if (words == "list") return list_text(answer.at("items"));
  if (words == "get") return value_text(answer);
  if (words == "set" || words == "undo") return change_text(answer);
  if (words == "save") return save_text(answer);
  if (words == "fault list") return fault_list(answer);
  if (words == "drives") return drives_text(answer);
  if (words == "world") return world_text(answer);
  const std::string text = answer.value("text", std::string());
  return text.empty() ? "" : text + "\n";
}

// With a newline.
std::string watch_head(const Json& answer) {
  std::string text = "time_s";
  for (const Json& signal : answer.at("signals")) text += "\t" + signal.at("name").get<std::string>();
  return text + "\n";
}

// Without a newline.
std::string watch_line(const Json& sample) {
  std::string text = printed("%.3f", sample.at("time_s").get<double>());
  for (const Json& value : sample.at("values")) text += "\t" + number(value);
  return text;
}

constexpr int answer_ms = 15'000;  // longer than the server waits for the behavior thread
constexpr int keys_ms = 100;

std::string answer_to(const Json& request, CtlLink& link) {
  link.send(json_text(request));
  const std::optional<std::string> line = link.receive(answer_ms);
  if (!line) refuse("the instance does not answer");
  return *line;
}
Json ask(CtlLink& link, const char* verb, const std::string& text) {
  return parse_foreign_json(answer_to({{"verb", verb}, {"text", text}}, link));
}

int from_pipe(CtlLink& link) {
  int code = exit_passed;
  for (std::string line; std::getline(std::cin, line);) {
    const Json answer = ask(link, "line", line);
    if (answer.value("ok", false)) {
      const std::string text = answer.at("text");
      if (!text.empty()) print_text(text + "\n");
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
  LineEditor editor("kadans> ", [&link](const std::string& text) {
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

// A console is a mode of the command line that uses two orders of the sockets.
constexpr const char *console = "repl", *console_doc = "Open a console in the running instance";

// "--rate" of an argument that is shown as "--rate HZ"; "" when the argument is no option.
std::string option_name(const OrderArgument& argument) {
  const std::string shown = argument.shown;
  return argument.is_option() ? shown.substr(0, shown.find(' ')) : std::string();
}

Json request_of(const OrderInfo& order, const CtlOptions& options) {
  Json request{{"verb", order.verb}};
  for (const OrderArgument& argument : order.arguments) {
    const auto given = options.given.find({order.verb, argument.name});
    if (given == options.given.end() || given->second.empty()) continue;
    const std::string& first = given->second.front();
    using Kind = OrderArgument::Kind;
    if (argument.kind == Kind::text) request[argument.name] = first;
    if (argument.kind == Kind::number) request[argument.name] = number_of<double>(first).value();
    if (argument.kind == Kind::flag) request[argument.name] = true;
    if (argument.kind == Kind::texts) request[argument.name] = given->second;
  }
  return request;
}

int watch(CtlLink& link, const CtlOptions& options, const Json& answer) {
  catch_interrupts();
  if (!options.json) print_text(watch_head(answer));
  for (long seen = 0; !options.count || seen < *options.count; ++seen) {
    std::optional<std::string> line;
    while (!line && !interrupted()) line = link.receive(200);
    if (interrupted()) break;
    print_text((options.json ? *line : watch_line(parse_foreign_json(*line))) + "\n");
    if (std::fflush(stdout) != 0) break;  // nobody reads on, or nothing can be written: the program's end tells it
  }
  return exit_passed;
}

int talk_to_console(const CtlOptions& options) {
  CtlLink link(options.socket, Role::develop);
  if (options.json) refuse("--json", "a console is for people: repl has none");
  return isatty(STDIN_FILENO) == 1 ? from_terminal(link) : from_pipe(link);
}

int talk(const OrderInfo& order, const CtlOptions& options) {
  CtlLink link(options.socket, order.role);
  const std::string line = answer_to(request_of(order, options), link);
  const Json answer = parse_foreign_json(line);
  if (!answer.value("ok", false)) {
    if (options.json) print_text(line + "\n");
    print_error(answer.value("error", "refused"));
    return exit_failed;
  }
  if (std::string_view(order.verb) == "watch") return watch(link, options, answer);
  if (options.names && !options.json) {
    for (const Json& item : answer.at("items")) print_text(item.at("name").get<std::string>() + "\n");
    return exit_passed;
  }
  print_text(options.json ? line + "\n" : answer_text(order.words, answer));
  return exit_passed;
}

void add_argument(CLI::App& to, const OrderInfo& order, const OrderArgument& argument, CtlOptions& options) {
  std::vector<std::string>& given = options.given[{order.verb, argument.name}];
  if (argument.kind == OrderArgument::Kind::flag) {
    to.add_flag_callback(
        option_name(argument), [&given] { given = {"yes"}; }, argument.doc);
    return;
  }
  const bool option = argument.is_option();
  const std::string shown = argument.shown;
  const std::string named = option ? option_name(argument) : argument.name;
  CLI::Option* added = nullptr;
  if (argument.kind == OrderArgument::Kind::texts) {
    added = to.add_option(named, given, argument.doc);
  } else {
    const auto take = [&given](const std::string& text) { given = {text}; };
    added = to.add_option_function<std::string>(named, take, argument.doc);
  }
  added->type_name(option ? shown.substr(shown.find(' ') + 1) : shown)->required(argument.required);
  if (argument.kind == OrderArgument::Kind::number) added->check(number_within(argument.min, argument.max));
}

// "Records: start, stop, dump".
CLI::App* add_group(CLI::App& ctl, const std::string& group) {
  std::string doc;
  for (const OrderInfo& order : order_table::orders) {
    const std::string_view words = order.words;
    if (words.starts_with(group + " ")) doc += (doc.empty() ? "" : ", ") + std::string(words.substr(group.size() + 1));
  }
  CLI::App* to = ctl.add_subcommand(group, "Orders about " + group + "s: " + doc);
  return to->require_subcommand(1)->fallthrough();
}

// Splits "record start" into the group "record" and "start"; for a single word the group is "".
std::pair<std::string, std::string> group_of(const OrderInfo& order) {
  const std::string words = order.words;
  const std::size_t blank = words.find(' ');
  if (blank == std::string::npos) return {"", words};
  return {words.substr(0, blank), words.substr(blank + 1)};
}

void add(CLI::App& ctl, const OrderInfo& order, CtlOptions& options) {
  const auto [group, word] = group_of(order);
  CLI::App* to = &ctl;
  if (!group.empty()) {
    const auto there =
        ctl.get_subcommands([&wanted = group](const CLI::App* one) { return one->get_name() == wanted; });
    to = there.empty() ? add_group(ctl, group) : there.front();
  }
  CLI::App* added = to->add_subcommand(word, order.doc)->fallthrough();
  for (const OrderArgument& argument : order.arguments) {
    if (argument.shown[0] != '\0') add_argument(*added, order, argument, options);
  }
}

// The words of the command line without --host and its value.
std::vector<std::string> without_host(std::vector<std::string> words) {
  const auto found = std::ranges::find_if(
      words, [](const std::string& word) { return word == "--host" || word.starts_with("--host="); });
  if (found == words.end()) return words;
  const bool two = *found == "--host" && std::next(found) != words.end();
  words.erase(found, found + (two ? 2 : 1));
  return words;
}

int run_ctl(const CommandLine& line, const CtlOptions& options) {
  if (!options.host.empty()) {
    const std::vector<std::string> words(line.arguments().begin() + 1, line.arguments().end());
    return RemoteHost(options.host).run(without_host(words), STDIN_FILENO, true);
  }
  std::string verb;
  for (const CLI::App* at = line.app.get_subcommand("ctl"); !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    verb += (verb.empty() ? "" : " ") + at->get_name();
  }
  if (verb == console) return talk_to_console(options);
  for (const OrderInfo& order : order_table::orders) {
    if (verb == order.words) return talk(order, options);
  }
  return exit_usage;
}

}  // namespace

void add_ctl(CommandLine& line) {
  const auto [ctl, options] = line.add<CtlOptions>("ctl", "Read, command and tune a running instance", run_ctl);
  ctl->require_subcommand(1)->fallthrough();
  ctl->add_option("--socket", options.socket,
                  "Folder of the instance's sockets, or one socket (default: see docs/ctl.md)")
      ->type_name("PATH");
  ctl->add_option("--host", options.host, "Another computer, reached over ssh, as ssh takes it: kadans@robot.local")
      ->type_name("HOST");
  ctl->add_flag("--json", options.json, "Print the answer as JSON; samples as one object a line");
  for (const OrderInfo& order : order_table::orders) {
    if (order.words[0] != '\0') add(*ctl, order, options);
  }
  ctl->add_subcommand(console, console_doc)->fallthrough();
  ctl->get_subcommand("list")->add_flag("--names", options.names, "Print only names, one a line");
  ctl->get_subcommand("list")->get_option("what")->check(CLI::IsMember(list_kinds()));
  add_whole(*ctl->get_subcommand("watch"), "--count", options.count, 1, 1'000'000'000, "End after N samples");
  ctl->footer("Exit codes: 0 done, 1 refused, 2 wrong usage or no instance. docs/ctl.md tells of roles and sockets.");
}

}  // namespace kadans
