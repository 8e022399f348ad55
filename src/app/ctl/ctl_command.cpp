#include "ctl/ctl_command.h"

#include <cstdio>
#include <functional>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "ctl/ctl_console.h"
#include "ctl/ctl_print.h"
#include "kadans/config/foreign_json.h"
#include "kadans/remote/ctl_link.h"
#include "kadans/signal/input_error.h"
#include "option_checks.h"
#include "terminal.h"

namespace kadans {
namespace {

constexpr int reply_ms = 15'000;  // longer than the server waits for its instance

// A verb of the command line, what it asks for, and who may.
struct Verb {
  const char* words;
  Role role;
  const char* doc;
};
const Verb verbs[] = {
    {"status", Role::read, "What it is, what it does, how it is"},
    {"list", Role::read, "behaviors, sets, objects, parameters or signals"},
    {"get", Role::read, "The value of a parameter or signal"},
    {"watch", Role::read, "Values of signals as they change, until Ctrl-C"},
    {"fault list", Role::read, "What went wrong so far"},
    {"fault clear", Role::operate, "Let the safety layer forget its faults"},
    {"estop", Role::operate, "Emergency stop: damp at once, then off, until faults are cleared"},
    {"play", Role::operate, "Behaviors behind what plays: \"squat{depth_m=0.08}, wave\""},
    {"pause", Role::operate, "Behaviors and motions stand still"},
    {"resume", Role::operate, "They go on"},
    {"stop", Role::operate, "End what plays"},
    {"switch", Role::operate, "Another control set"},
    {"record start", Role::operate, "Begin a record"},
    {"record stop", Role::operate, "End it"},
    {"record dump", Role::operate, "Write what the flight recorder has of the last seconds"},
    {"set", Role::develop, "Give a parameter another value"},
    {"undo", Role::develop, "Take the last set back; again for the one before"},
    {"save", Role::develop, "Write what was set into the robot's configuration"},
    {"reload", Role::develop, "Read a behavior's file again, or those of all that play"},
    {"repl", Role::develop, "A console in the running instance"},
};

const char* doc_of(const std::string& words) {
  for (const Verb& verb : verbs) {
    if (verb.words == words) return verb.doc;
  }
  return "";
}

Json request_of(const std::string& words, const CtlOptions& options) {
  if (words == "list") return {{"verb", words}, {"what", options.what}};
  if (words == "get") return {{"verb", words}, {"name", options.name}};
  if (words == "set") return {{"verb", words}, {"name", options.name}, {"value", options.value}};
  if (words == "play") return {{"verb", words}, {"list", options.list}, {"replace", options.replace}};
  if (words == "switch") return {{"verb", words}, {"set", options.name}};
  if (words == "watch") return {{"verb", words}, {"signals", options.signals}, {"rate_hz", options.rate_hz}};
  if (words == "save" && !options.preset.empty()) return {{"verb", words}, {"preset", options.preset}};
  if (words == "fault list") return {{"verb", "faults"}};
  if (words == "fault clear") return {{"verb", "clear_faults"}};
  if (words == "record stop") return {{"verb", "record_stop"}};
  if (words == "record dump") return {{"verb", "record_dump"}};
  Json request{{"verb", words == "record start" ? "record_start" : words}};
  if (!options.name.empty()) request[words == "reload" ? "name" : "file"] = options.name;
  return request;
}

int watch(CtlLink& link, const CtlOptions& options, const Json& answer) {
  catch_interrupts();
  if (!options.json) std::fputs(watch_head(answer).c_str(), stdout);
  for (long seen = 0; !options.count || seen < *options.count; ++seen) {
    std::optional<std::string> line;
    while (!line && !interrupted()) line = link.receive(200);
    if (interrupted()) break;
    std::puts(options.json ? line->c_str() : watch_line(parse_foreign_json(*line)).c_str());
    std::fflush(stdout);
  }
  return exit_passed;
}

int talk(const Verb& verb, const CtlOptions& options) {
  CtlLink link(options.socket, verb.role);
  if (std::string(verb.words) == "repl") {
    if (options.json)
      throw InputError(InputProblem{.file = "--json", .message = "a console is for people: repl has none"});
    return ctl_console(link);
  }
  link.send(json_text(request_of(verb.words, options)));
  const std::optional<std::string> line = link.receive(reply_ms);
  if (!line) throw InputError({.message = "the instance does not answer"});
  const Json answer = parse_foreign_json(*line);
  if (!answer.value("ok", false)) {
    if (options.json) std::puts(line->c_str());
    print_error(answer.value("error", "refused"));
    return exit_failed;
  }
  if (std::string(verb.words) == "watch") return watch(link, options, answer);
  if (options.names && !options.json) {
    for (const Json& item : answer.at("items")) std::puts(item.at("name").get<std::string>().c_str());
    return exit_passed;
  }
  std::fputs(options.json ? (*line + "\n").c_str() : answer_text(verb.words, answer).c_str(), stdout);
  return exit_passed;
}

// "record start" under record.
CLI::App* add(CLI::App& to, const std::string& words) {
  const std::size_t blank = words.find(' ');
  CLI::App* verb = to.add_subcommand(blank == std::string::npos ? words : words.substr(blank + 1), doc_of(words));
  return verb->fallthrough();
}

void add_looking(CLI::App& ctl, CtlOptions& options) {
  add(ctl, "status");
  CLI::App* list = add(ctl, "list");
  list->add_flag("--names", options.names, "Their names alone, one a line");
  list->add_option("what", options.what, "behaviors, sets, objects, parameters or signals")
      ->required()
      ->check(CLI::IsMember({"behaviors", "sets", "objects", "parameters", "signals"}));
  add(ctl, "get")->add_option("name", options.name)->required()->type_name("NAME");
  CLI::App* watched = add(ctl, "watch");
  watched->add_option("signals", options.signals)->required()->type_name("SIGNAL...");
  watched->add_option("--rate", options.rate_hz, "Samples a second at most (default: 10)")
      ->type_name("HZ")
      ->check(number_within(0.01, 1000.0));
  watched->add_option("--count", options.count, "Ends after so many samples")
      ->type_name("N")
      ->check(whole_within(1, 1'000'000'000));
}

void add_operating(CLI::App& ctl, CtlOptions& options) {
  CLI::App* play = add(ctl, "play");
  play->add_option("list", options.list)->required()->type_name("LIST");
  play->add_flag("--replace", options.replace, "In place of what plays");
  for (const char* plain : {"pause", "resume", "stop", "estop"}) add(ctl, plain);
  add(ctl, "switch")->add_option("set", options.name)->required()->type_name("SET");
  CLI::App* fault = ctl.add_subcommand("fault", "Faults: list, clear");
  fault->require_subcommand(1)->fallthrough();
  add(*fault, "fault list");
  add(*fault, "fault clear");
  CLI::App* record = ctl.add_subcommand("record", "Records: start, stop, dump");
  record->require_subcommand(1)->fallthrough();
  add(*record, "record start")
      ->add_option("file", options.name, "Its name (default: robot and time)")
      ->type_name("FILE");
  add(*record, "record stop");
  add(*record, "record dump");
}

void add_developing(CLI::App& ctl, CtlOptions& options) {
  CLI::App* set = add(ctl, "set");
  set->add_option("name", options.name)->required()->type_name("NAME");
  set->add_option("value", options.value)->required()->type_name("X")->check(any_number());
  for (const char* plain : {"undo", "repl"}) add(ctl, plain);
  add(ctl, "save")->add_option("--preset", options.preset, "Also into this preset, what it sets")->type_name("NAME");
  add(ctl, "reload")->add_option("name", options.name)->type_name("NAME");
}

}  // namespace

void add_ctl(CLI::App& app, CtlOptions& options) {
  CLI::App* ctl = app.add_subcommand("ctl", "Look into a running instance, command it, tune it");
  ctl->require_subcommand(1)->fallthrough();
  ctl->add_option("--socket", options.socket, "Its folder of sockets, or one socket (default: where they usually are)")
      ->type_name("PATH");
  ctl->add_flag("--json", options.json, "Print the answer as JSON, samples as one object a line");
  add_looking(*ctl, options);
  add_operating(*ctl, options);
  add_developing(*ctl, options);
  ctl->footer("Exit codes: 0 done, 1 refused, 2 wrong usage or no instance. docs/ctl.md tells of roles and sockets.");
}

int run_ctl(const CLI::App& app, const CtlOptions& options) {
  const CLI::App* ctl = app.get_subcommand("ctl");
  for (const Verb& verb : verbs) {
    const std::string words = verb.words;
    const std::size_t blank = words.find(' ');
    const std::string first = words.substr(0, blank);
    if (!ctl->got_subcommand(first)) continue;
    if (blank == std::string::npos || ctl->get_subcommand(first)->got_subcommand(words.substr(blank + 1)))
      return talk(verb, options);
  }
  return exit_usage;
}

}  // namespace kadans
