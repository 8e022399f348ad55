#include <cerrno>
#include <csignal>
#include <cstring>

#include <CLI/CLI.hpp>
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "debug_session.h"

namespace kadans {
namespace {

[[noreturn]] void fail(int port) { refuse("--port " + std::to_string(port), std::strerror(errno)); }

// Waits for one editor at a port of this machine, which no other machine reaches.
int accepted_editor(int port) {
  const int listening = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (listening < 0) fail(port);
  const int yes = 1;
  (void)setsockopt(listening, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof address;
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  if (bind(listening, plain, size) != 0 || listen(listening, 1) != 0) fail(port);
  if (getsockname(listening, plain, &size) != 0) fail(port);
  print_line("waits for an editor at 127.0.0.1:" + std::to_string(ntohs(address.sin_port)));
  int editor = -1;
  do editor = accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
  while (editor < 0 && errno == EINTR);
  if (editor < 0) fail(port);
  (void)setsockopt(editor, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  close(listening);
  return editor;
}

// The editor gets the protocol on stdout, so nothing else is printed there.
int run_debug(const DebugOptions& options) {
  if (options.port && options.file.empty())  // whoever connects does not choose what runs
    refuse("--port", "name the scenario or record, too");
  std::signal(SIGPIPE, SIG_IGN);
  const int editor = options.port ? accepted_editor(*options.port) : -1;
  const DapStream stream = editor < 0 ? DapStream(STDIN_FILENO, STDOUT_FILENO) : DapStream(editor, editor);
  return DebugSession(options, stream).run();
}

}  // namespace

void add_debug(CommandLine& line) {
  const auto [debug, options] = line.add<DebugOptions>(
      "debug", "Let an editor debug the behaviors of a simulation or a record, forwards and backwards", run_debug);
  debug->add_option("file", options.file, "Scenario (JSON) or record (MCAP); default: what the editor launches")
      ->type_name("FILE");
  add_whole(*debug, "--port", options.port, 0, 65535,
            "Wait for the editor at this port of this machine; 0: any free one (default: stdin and stdout)");
  add_number(*debug, "--memory", options.memory_MB, 16.0, 1e6, "MB",
             "Memory for the copies of the run from which it goes back (default: 1024)");
  debug->add_flag("--from-record", options.from_record, "Use the files inside the record, not those on the disk");
  debug->add_flag("--allow-plugins", options.allow_plugins,
                  "Load the project's plug-ins, even if they differ from the record's");
}

}  // namespace kadans
