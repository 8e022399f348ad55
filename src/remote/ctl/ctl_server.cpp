#include "ctl_server.h"

#include <algorithm>
#include <cerrno>
#include <map>
#include <system_error>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "remote/order/order_json.h"
#include "signal/quiet_thread.h"

namespace kadans {
namespace {

constexpr std::size_t stack_bytes = std::size_t{512} * 1024;
constexpr int idle_ms = 200;                   // events and faults wait so long at most
constexpr int busy_ms = 2;                     // between looks for an answer or a sample
constexpr std::int64_t deaf_ns = 100'000'000;  // after the process ran out of descriptors
constexpr std::array roles{Role::read, Role::operate, Role::develop};

bool has_left(int socket) noexcept {
  pollfd watched{.fd = socket, .events = 0, .revents = 0};
  return poll(&watched, 1, 0) > 0 && (watched.revents & (POLLHUP | POLLERR)) != 0;
}

}  // namespace

CtlServer::CtlServer(Instance& instance, const CtlSockets& sockets, const Settings& settings)
    : sockets_(sockets),
      settings_(settings),
      port_(instance.open_port()),
      requests_(instance, port_, counts_),
      wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

void CtlServer::start() {
  if (running_) return;
  if (!wake_) throw std::system_error(errno, std::generic_category(), "eventfd");
  const int failed = start_quiet_thread<&CtlServer::run>(thread_, {"ctl", stack_bytes}, this);
  if (failed != 0) throw std::system_error(failed, std::generic_category(), "the thread that serves ctl");
  running_ = true;
}

void CtlServer::stop() noexcept {
  if (!running_) return;
  stop_.store(true, std::memory_order_relaxed);
  (void)eventfd_write(wake_.number(), 1);
  pthread_join(thread_, nullptr);
  running_ = false;
  guests_.clear();
}

void CtlServer::run() {
  accept_waiting();
  while (!stop_.load(std::memory_order_relaxed)) {
    wait();
    take_answers();
    send_samples();
    expire();
    requests_.upkeep();
    std::erase_if(guests_, [this](const Guest& guest) {
      if (!guest.gone) return false;
      heed_last_lines(*guest.session);
      requests_.forget(*guest.session);
      return true;
    });
  }
}

int CtlServer::patience_ms() const noexcept {
  const bool busy = std::ranges::any_of(
      guests_, [](const Guest& guest) { return guest.session->order != 0 || !guest.session->watched.empty(); });
  return busy ? busy_ms : idle_ms;
}

// Until somebody connects, says something, can be told something or leaves; or for a while.
void CtlServer::wait() {
  std::vector<pollfd> watched{{.fd = wake_.number(), .events = POLLIN, .revents = 0}};
  const bool deaf = clock_.now_ns() < deaf_until_ns_;
  for (const Role role : roles) watched.push_back({deaf ? -1 : sockets_.listener(role), POLLIN, 0});
  for (const Guest& guest : guests_) {
    const CtlSession& session = *guest.session;
    const int events = (session.wants_to_read() ? POLLIN : 0) | (session.wants_to_write() ? POLLOUT : 0);
    watched.push_back({session.socket(), static_cast<short>(events), 0});
  }
  const std::size_t known = guests_.size();
  if (poll(watched.data(), watched.size(), patience_ms()) < 0) return;
  now_ns_ = clock_.now_ns();
  for (std::size_t i = 0; i < known; ++i) serve(guests_[i], watched[i + 1 + roles.size()].revents);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (watched[i + 1].revents != 0) accept_all(roles[i]);
  }
}

// Who came before anybody served, and gave up: what it asked for is not wanted any more, be it the emergency stop.
void CtlServer::accept_waiting() {
  for (const Role role : roles) accept_all(role);
  std::erase_if(guests_, [](const Guest& guest) { return guest.session->leaves; });
}

// The emergency stop counts of whoever has gone, too, whatever stood before it and was not answered yet.
void CtlServer::heed_last_lines(CtlSession& session) {
  session.leaves = true;
  for (const std::string& line : session.last_lines(now_ns_)) (void)requests_.take(session, line);
}

// Room for one more of this user: where there is none, the one that has been idle for longest goes, of the user who has
// most of the role, so that nobody keeps others out by staying. Who waits for an answer stays, and among those of one
// user who watches.
bool CtlServer::make_room(Role role, std::uint32_t user) {
  std::map<std::uint32_t, std::size_t> of_user;
  std::size_t there = 0;
  for (const Guest& guest : guests_) {
    if (guest.gone || guest.session->role() != role) continue;
    ++of_user[guest.session->user()];
    ++there;
  }
  if (there < settings_.clients_max[static_cast<std::size_t>(role)]) return true;
  const auto most = std::ranges::max_element(of_user, {}, [](const auto& entry) { return entry.second; });
  Guest* idle = nullptr;
  for (Guest& guest : guests_) {
    const CtlSession& session = *guest.session;
    if (guest.gone || session.role() != role || session.user() != most->first || session.order != 0) continue;
    if (!session.watched.empty() && most->first == user) continue;
    if (idle == nullptr || session.heard_ns() < idle->session->heard_ns()) idle = &guest;
  }
  if (idle == nullptr) return false;
  drop(*idle, "another client needed the place");
  return true;
}

void CtlServer::accept_all(Role role) {
  for (int burst = 0; burst < 64; ++burst) {
    const int socket = accept4(sockets_.listener(role), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (socket < 0 && (errno == EMFILE || errno == ENFILE)) deaf_until_ns_ = now_ns_ + deaf_ns;
    if (socket < 0) return;
    const bool left = has_left(socket);
    auto session = std::make_unique<CtlSession>(socket, role, next_number_++, now_ns_);
    session->leaves = left;
    if (make_room(role, session->user())) {
      guests_.push_back({std::move(session)});
      counts_.served.fetch_add(left ? 0 : 1, std::memory_order_relaxed);
      continue;
    }
    const std::string line = refusal(std::string("there are too many clients with the role ") + name(role)) + "\n";
    (void)send(socket, line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    counts_.refused.fetch_add(1, std::memory_order_relaxed);
  }
}

// A client that has said its last word still gets the answers to what it asked.
void CtlServer::serve(Guest& guest, short events) {
  CtlSession& session = *guest.session;
  session.leaves = session.leaves || (events & (POLLHUP | POLLERR)) != 0;
  if ((events & POLLIN) != 0 && !session.receive(now_ns_)) {
    if (session.too_long()) return drop(guest, "a line has at most 64 kB");
    guest.gone = true;
  } else if ((events & POLLIN) == 0 && (events & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
    guest.gone = true;
  }
  if ((events & POLLOUT) != 0 && !session.transmit(now_ns_)) guest.gone = true;
  if (!guest.gone) answer_requests(guest);
}

void CtlServer::answer_requests(Guest& guest) {
  CtlSession& session = *guest.session;
  std::string line;
  while (session.take_line(line, now_ns_)) {
    const std::string answer = requests_.take(session, line);
    if (session.order != 0) {
      session.ordered_ns = now_ns_;
      return;
    }
    session.say(answer, now_ns_);
    if (!session.transmit(now_ns_)) guest.gone = true;
  }
}

void CtlServer::take_answers() {
  for (Answer answer; port_.next(answer);) {
    for (Guest& guest : guests_) {
      CtlSession& session = *guest.session;
      if (guest.gone || session.order != answer.number) continue;
      session.say(requests_.answered(session, &answer), now_ns_);
      if (!session.transmit(now_ns_)) guest.gone = true;
      if (!guest.gone) answer_requests(guest);
    }
    answer = {};
  }
}

// The newest value to whoever has read the last one.
void CtlServer::send_samples() {
  for (Guest& guest : guests_) {
    CtlSession& session = *guest.session;
    if (guest.gone || session.watched.empty() || session.wants_to_write()) continue;
    const std::string line = requests_.sample(session);
    if (line.empty()) continue;
    session.say(line, now_ns_);
    if (!session.transmit(now_ns_)) guest.gone = true;
  }
}

void CtlServer::expire() {
  for (Guest& guest : guests_) {
    CtlSession& session = *guest.session;
    if (guest.gone) continue;
    guest.gone = session.finished();
    if (session.half_since(now_ns_ - settings_.half_line_max_ns)) drop(guest, "the rest of the line did not come");
    if (session.unread_since(now_ns_ - settings_.unread_max_ns)) drop(guest, "");
    if (session.order == 0) continue;
    const std::int64_t patience_ns = requests_.reports(session) ? settings_.report_max_ns : settings_.answer_max_ns;
    if (session.ordered_ns < now_ns_ - patience_ns) session.say(requests_.answered(session, nullptr), now_ns_);
  }
}

void CtlServer::drop(Guest& guest, const std::string& why) {
  if (!why.empty()) {
    guest.session->say(refusal(why), now_ns_);
    (void)guest.session->transmit(now_ns_);
  }
  guest.gone = true;
  counts_.dropped.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace kadans
