
#include "live_connection.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "live_client.h"
#include "page_files.h"

namespace kadans {
namespace {

// All characters are looked at, so that the time tells nothing.
bool same(std::string_view a, std::string_view b) noexcept {
  unsigned difference = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0 && !b.empty();
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

// "[::1]:8765" -> "::1", "localhost:8765" -> "localhost"; "" where it is none.
std::string name_in(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos || (end + 1 < host.size() && host[end + 1] != ':')) return "";
    return in_lower_case(host.substr(1, end - 1));
  }
  return in_lower_case(host.substr(0, host.find(':')));
}

// "http://localhost:8765" -> "localhost:8765"
std::string_view site_in(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return origin.substr(scheme.size());
  }
  return {};
}

}  // namespace

LiveAccess::LiveAccess(std::string token, std::vector<std::string> hosts)
    : token_(std::move(token)), hosts_(std::move(hosts)) {
  for (std::string& host : hosts_) host = in_lower_case(host);
}

bool LiveAccess::is_ours(std::string_view host, const std::string& reached_at) const {
  const std::string name = name_in(host);
  if (name.empty()) return false;
  if (name == reached_at || name == "localhost" || name == "127.0.0.1" || name == "::1") return true;
  return std::ranges::find(hosts_, name) != hosts_.end();
}

Access LiveAccess::of(const Knock& knock) const {
  if (same(knock.token, token_)) return Access::writes;
  if (!is_ours(knock.host, knock.reached_at)) return Access::wrong_host;
  if (!knock.origin.empty() && in_lower_case(site_in(knock.origin)) != in_lower_case(knock.host))
    return Access::other_site;
  return Access::reads;
}

const char* LiveAccess::why(Access refused) noexcept {
  if (refused == Access::other_site) return "a page of another site needs the token\n";
  return "this server is not called so; without the token use its address, or start it with --live-host NAME\n";
}

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Request = http::request<http::string_body>;
using Error = beast::error_code;

constexpr std::array subprotocols{std::string_view("foxglove.sdk.v1"), std::string_view("foxglove.websocket.v1")};
// These bounds stand in docs/security.md, too.
constexpr std::uint32_t head_max_bytes = 8 * 1024;
constexpr std::size_t frame_max_bytes = std::size_t{64} << 20U;  // a picture, from who has the token
constexpr std::size_t message_max_bytes = 64 * 1024, message_with_token_max_bytes = std::size_t{1} << 20U;
constexpr int send_buffer_bytes = 256 * 1024;  // of the system, for a client that does not read
constexpr std::chrono::seconds request_time{30}, stall_time{30}, farewell_time{2};

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

std::string_view query(std::string_view target, std::string_view key) {
  std::size_t at = target.find('?');
  while (at != std::string_view::npos) {
    const std::size_t end = target.find('&', at + 1);
    const std::string_view pair = target.substr(at + 1, end == std::string_view::npos ? end : end - at - 1);
    const std::size_t equals = pair.find('=');
    if (pair.substr(0, equals) == key) return equals == std::string_view::npos ? "" : pair.substr(equals + 1);
    at = end;
  }
  return {};
}

std::string_view media_type(std::string_view path) {
  const std::string_view kind = path.substr(std::min(path.size(), path.rfind('.')));
  if (kind == ".html") return "text/html; charset=utf-8";
  if (kind == ".js") return "text/javascript";
  if (kind == ".css") return "text/css";
  if (kind == ".urdf") return "application/xml";
  return "application/octet-stream";
}

// The best of those that the client offers; "": none that is known.
std::string_view chosen_subprotocol(std::string_view offered) {
  for (const std::string_view known : subprotocols) {
    for (const beast::string_view one : http::token_list({offered.data(), offered.size()})) {
      if (view(one) == known) return known;
    }
  }
  return {};
}

class Connection final : public LiveConnection {
 public:
  Connection(asio::ip::tcp::socket socket, const LiveSite& site, std::uint64_t id)
      : stream_(std::move(socket)), site_(site), id_(id) {
    Error ignored;
    reached_at_ = tcp().socket().local_endpoint(ignored).address().to_string();
    const asio::ip::address peer = tcp().socket().remote_endpoint(ignored).address();
    local_ = peer.is_loopback();
    who_ = "the page at " + peer.to_string();
    turn_ = site_.crowd->next_turn();
  }

  void start() override {
    Error ignored;
    tcp().socket().set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
    tcp().socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    read_request();
  }
  void beat() noexcept override {
    if (client_ == nullptr || closed_) return;
    guarded([this] {
      client_->tell_changes();
      pump();
    });
  }
  void close() noexcept override {
    if (closed_) return;
    closed_ = true;
    Error ignored;
    tcp().socket().close(ignored);
    tcp().cancel();
  }
  Standing standing() const noexcept override {
    if (client_ == nullptr) return Standing::request;
    return trusted_ ? Standing::writer : Standing::reader;
  }
  bool closed() const noexcept override { return closed_; }
  bool over() const noexcept override { return closed_ && under_way_ == 0; }
  bool local() const noexcept override { return local_; }
  bool trusted() const noexcept override { return trusted_; }
  std::uint64_t turn() const noexcept override { return turn_; }

 private:
  beast::tcp_stream& tcp() noexcept { return beast::get_lowest_layer(stream_); }

  // Whatever goes wrong ends this connection and nothing else.
  template <typename Act>
  void guarded(Act act) noexcept {
    try {
      act();
    } catch (...) {
      close();
    }
  }

  // Counts the operation until its handler is through.
  template <typename Handler>
  auto counted(Handler handler) {
    ++under_way_;
    return [this, handler](const Error& error, std::size_t = 0) {
      --under_way_;
      if (error) return close();
      if (!closed_) guarded(handler);
    };
  }

  void read_request() {
    parser_.emplace();
    parser_->header_limit(head_max_bytes);
    parser_->body_limit(frame_max_bytes);
    tcp().expires_after(request_time);
    http::async_read_header(stream_.next_layer(), buffer_, *parser_, counted([this] { take_head(parser_->get()); }));
  }

  Access access_of(const Request& request) const {
    const std::string_view target = view(request.target());
    return site_.access.of({.host = view(request[http::field::host]),
                            .origin = view(request[http::field::origin]),
                            .token = query(target, "token"),
                            .reached_at = reached_at_});
  }

  void take_head(const Request& request) {
    turn_ = site_.crowd->next_turn();
    const Access access = access_of(request);
    trusted_ = access == Access::writes;
    if (access == Access::wrong_host || access == Access::other_site)
      return refuse(http::status::forbidden, LiveAccess::why(access));
    if (websocket::is_upgrade(request)) return upgrade(request);
    const std::string_view path = path_of(view(request.target()));
    if (request.method() == http::verb::post && path.starts_with("/frames/")) return read_frame();
    if (request.method() != http::verb::get) return refuse(http::status::method_not_allowed, "only GET\n");
    if (!parser_->is_done()) return refuse(http::status::payload_too_large, "a GET has no body\n");
    if (path == "/record.mcap" && !site_.record.file.empty()) return send_record();
    if ((site_.hub != nullptr || site_.record.read_mesh) && path.starts_with("/asset/"))
      return send_asset(path.substr(7));
    send_page(path == "/" ? "/index.html" : path);
  }

  void read_frame() {
    if (!trusted_ || !site_.record.take_frame) return refuse(http::status::forbidden, "the token is needed\n");
    http::async_read(stream_.next_layer(), buffer_, *parser_, counted([this] {
                       const std::string_view path = path_of(view(parser_->get().target()));
                       site_.record.take_frame(std::string(path.substr(8)), parser_->get().body());
                       reply(http::status::ok, "text/plain", {});
                     }));
  }

  void send_page(std::string_view path) {
    if (page_files().empty()) return refuse(http::status::service_unavailable, std::string(page_is_missing));
    const auto found = std::ranges::find(page_files(), path, &PageFile::path);
    if (found == page_files().end()) return refuse(http::status::not_found, "there is no such file\n");
    reply(http::status::ok, media_type(path), {reinterpret_cast<const char*>(found->gzip.data()), found->gzip.size()},
          true);
  }

  void send_asset(std::string_view name) {
    content_ = site_.hub != nullptr ? site_.hub->assets().read(name) : site_.record.read_mesh(name);
    if (!content_) return refuse(http::status::not_found, "there is no such asset\n");
    reply(http::status::ok, media_type(name), *content_);
  }

  void send_record() {
    Error error;
    http::file_body::value_type body;
    body.open(site_.record.file.c_str(), beast::file_mode::scan, error);
    if (error) return refuse(http::status::not_found, "the record cannot be read\n");
    file_.emplace(std::piecewise_construct, std::make_tuple(std::move(body)), std::make_tuple(http::status::ok, 11));
    file_->set(http::field::content_type, "application/octet-stream");
    file_->prepare_payload();
    sender_.emplace(*file_);
    send_piece();
  }

  // However long the file is, each piece must be taken in its time.
  void send_piece() {
    tcp().expires_after(stall_time);
    http::async_write_some(stream_.next_layer(), *sender_, counted([this] {
                             if (!sender_->is_done()) return send_piece();
                             sender_.reset();
                             file_.reset();
                             read_request();
                           }));
  }

  // What may still come of the request is not waited for.
  void refuse(http::status status, const std::string& why) {
    leaves_ = !parser_->is_done();
    content_ = std::make_shared<const std::string>(why);
    reply(status, "text/plain; charset=utf-8", *content_);
  }

  // The body stays where it is until it is sent: in the program, or in content_.
  void reply(http::status status, std::string_view type, std::string_view body, bool gzip = false) {
    response_ = {};
    response_.result(status);
    response_.version(11);
    response_.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    response_.set(http::field::cache_control, "no-cache");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    if (gzip) response_.set(http::field::content_encoding, "gzip");
    response_.keep_alive(!leaves_);
    response_.body() = {body.data(), body.size()};
    response_.prepare_payload();
    tcp().expires_after(stall_time);
    http::async_write(stream_.next_layer(), response_, counted([this] {
                        response_ = {};
                        content_.reset();
                        leaves_ ? say_farewell() : read_request();
                      }));
  }

  // Closed at once, the connection could take the answer with it: what comes is thrown away for a moment.
  void say_farewell() {
    Error ignored;
    tcp().socket().shutdown(asio::socket_base::shutdown_send, ignored);
    tcp().expires_after(farewell_time);
    throw_away();
  }
  void throw_away() {
    buffer_.consume(buffer_.size());
    tcp().async_read_some(buffer_.prepare(head_max_bytes), counted([this] { throw_away(); }));
  }

  void upgrade(const Request& request) {
    const std::string_view subprotocol = chosen_subprotocol(view(request[http::field::sec_websocket_protocol]));
    if (site_.hub == nullptr) return refuse(http::status::not_found, "nothing runs here\n");
    if (subprotocol.empty()) return refuse(http::status::bad_request, "foxglove.sdk.v1 or foxglove.websocket.v1\n");
    if (!site_.crowd->make_room(trusted_, local_))
      return refuse(http::status::service_unavailable, "too many clients are connected\n");
    tcp().expires_never();
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, beast::string_view(subprotocol.data(), subprotocol.size()));
    }));
    stream_.read_message_max(trusted_ ? message_with_token_max_bytes : message_max_bytes);
    stream_.auto_fragment(false);  // a message is one write of the system
    stream_.async_accept(request, counted([this] { become_client(); }));
  }

  void become_client() {
    parser_.reset();
    client_ = std::make_unique<LiveClient>(*site_.hub, id_, trusted_, who_);
    buffer_.consume(buffer_.size());
    read_message();
    pump();
  }

  void read_message() {
    stream_.async_read(buffer_, counted([this] { take_message(); }));
  }

  void take_message() {
    const auto data = buffer_.cdata();
    const auto* bytes = static_cast<const std::byte*>(data.data());
    if (stream_.got_text()) {
      client_->text({reinterpret_cast<const char*>(bytes), data.size()});
    } else {
      client_->binary({bytes, data.size()});
    }
    buffer_.consume(buffer_.size());
    if (client_->hopeless()) return close();
    read_message();
    pump();
  }

  // One message at a time is on its way; what is newest then is the next.
  void pump() {
    if (closed_ || writing_) return;
    if (client_->hopeless()) return close();
    const bool more = client_->next(outgoing_);
    gather(more);
    if (!more) return;
    writing_ = true;
    stream_.binary(outgoing_.binary);
    stream_.async_write(asio::buffer(outgoing_.bytes.data(), outgoing_.bytes.size()), counted([this] {
                          writing_ = false;
                          pump();
                        }));
  }

  // The messages of a beat leave together, as few packets: each packet alone would cost the system as much as all.
  void gather(bool on) {
    if (gathers_ == on) return;
    gathers_ = on;
    const int cork = on ? 1 : 0;
    (void)setsockopt(tcp().socket().native_handle(), IPPROTO_TCP, TCP_CORK, &cork, sizeof cork);
  }

  websocket::stream<beast::tcp_stream> stream_;
  const LiveSite& site_;
  std::uint64_t id_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::span_body<const char>> response_;
  std::shared_ptr<const std::string> content_;  // of the response, unless it is the program's own
  std::optional<http::response<http::file_body>> file_;
  std::optional<http::response_serializer<http::file_body>> sender_;
  std::unique_ptr<LiveClient> client_;
  LiveClient::Outgoing outgoing_;
  std::string reached_at_, who_;
  std::uint64_t turn_ = 0;
  bool local_ = false, trusted_ = false;
  bool writing_ = false, closed_ = false, gathers_ = false, leaves_ = false;
  int under_way_ = 0;
};

}  // namespace

std::unique_ptr<LiveConnection> make_live_connection(asio::ip::tcp::socket socket, const LiveSite& site,
                                                     std::uint64_t id) {
  return std::make_unique<Connection>(std::move(socket), site, id);
}

namespace {

bool sooner_request(const LiveConnection& a, const LiveConnection& b) noexcept {
  return a.trusted() != b.trusted() ? b.trusted() : a.turn() < b.turn();
}

bool sooner_reader(const LiveConnection& a, const LiveConnection& b) noexcept {
  return a.local() != b.local() ? b.local() : a.turn() < b.turn();
}

}  // namespace

std::size_t LiveCrowd::count(Standing standing) const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(
      connections_, [standing](const auto& one) { return !one->closed() && one->standing() == standing; }));
}

LiveConnection* LiveCrowd::first(Standing standing,
                                 bool (*order)(const LiveConnection&, const LiveConnection&)) noexcept {
  LiveConnection* found = nullptr;
  for (const auto& one : connections_) {
    if (one->closed() || one->standing() != standing) continue;
    if (found == nullptr || order(*one, *found)) found = one.get();
  }
  return found;
}

void LiveCrowd::take(std::unique_ptr<LiveConnection> connection) {
  if (count(Standing::request) >= LiveServer::requests_max) (void)close_one();
  connections_.push_back(std::move(connection));
  connections_.back()->start();
}

bool LiveCrowd::close_one() noexcept {
  LiveConnection* const oldest = first(Standing::request, sooner_request);
  if (oldest != nullptr) oldest->close();
  return oldest != nullptr;
}

bool LiveCrowd::make_room(bool writes, bool local) noexcept {
  if (writes) return count(Standing::writer) < LiveServer::writers_max;
  if (count(Standing::reader) < LiveServer::readers_max) return true;
  if (local) first(Standing::reader, sooner_reader)->close();
  return local;
}

void LiveCrowd::beat() noexcept {
  for (const auto& connection : connections_) connection->beat();
  connections_.remove_if([](const auto& connection) { return connection->over(); });
}

std::uint32_t LiveCrowd::clients() const noexcept {
  return static_cast<std::uint32_t>(count(Standing::reader) + count(Standing::writer));
}

}  // namespace kadans
