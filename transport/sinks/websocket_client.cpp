#include "transport/sinks/websocket_client.hpp"

#include <fmt/format.h>
#include <libwebsockets.h>
#include <linux/sockios.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <thread>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/base/shared_library.hpp"

namespace vestige {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kServerPatience = 3s;  ///< for the server's answer, and for it to take bytes
/// A server that is still sending when the connection is cut may lose the last texts that were sent to it.
constexpr auto kClosingPatience = 1s;
constexpr auto kBetweenLooks = 1ms;
/// How often libwebsockets is called until a text has left: it may have something else to do first.
constexpr int kTries = 4;

/// The functions of libwebsockets. It is opened when it is first needed, because it brings OpenSSL along, which would
/// double the time that every verb takes to start.
struct Websockets {
  decltype(&::lws_set_log_level) set_log_level = nullptr;
  decltype(&::lws_create_context) create_context = nullptr;
  decltype(&::lws_context_destroy) destroy_context = nullptr;
  decltype(&::lws_context_user) user_of = nullptr;
  decltype(&::lws_get_context) context_of = nullptr;
  decltype(&::lws_client_connect_via_info) connect = nullptr;
  decltype(&::lws_service) service = nullptr;
  decltype(&::lws_get_socket_fd) descriptor_of = nullptr;
  decltype(&::lws_callback_on_writable) ask_to_write = nullptr;
  decltype(&::lws_write) write = nullptr;
  decltype(&::lws_partial_buffered) has_rest = nullptr;
  decltype(&::lws_send_pipe_choked) is_choked = nullptr;
  decltype(&::lws_close_reason) set_close_reason = nullptr;
  decltype(&::lws_set_timeout) set_timeout = nullptr;
};

Websockets load_websockets() {
  Websockets all;
  try {
    const SharedLibrary library("libwebsockets.so.17");
    library.find("lws_set_log_level", all.set_log_level);
    library.find("lws_create_context", all.create_context);
    library.find("lws_context_destroy", all.destroy_context);
    library.find("lws_context_user", all.user_of);
    library.find("lws_get_context", all.context_of);
    library.find("lws_client_connect_via_info", all.connect);
    library.find("lws_service", all.service);
    library.find("lws_get_socket_fd", all.descriptor_of);
    library.find("lws_callback_on_writable", all.ask_to_write);
    library.find("lws_write", all.write);
    library.find("lws_partial_buffered", all.has_rest);
    library.find("lws_send_pipe_choked", all.is_choked);
    library.find("lws_close_reason", all.set_close_reason);
    library.find("lws_set_timeout", all.set_timeout);
  } catch (const Error& error) {
    throw Error("bHaptics' Player needs libwebsockets", error.what(), "install it: apt-get install libwebsockets17");
  }
  return all;
}

const Websockets& websockets() {
  static const Websockets all = load_websockets();
  return all;
}

/// Returns an address of the host in digits, IPv4 if it has one. libwebsockets would wait for a name server at every
/// attempt to connect.
std::string address_of(const HostPort& place, const std::string& name) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = ::getaddrinfo(place.host.c_str(), nullptr, &hints, &found); error != 0)
    throw Error(name, fmt::format("the host '{}' is not known: {}", place.host, ::gai_strerror(error)),
                "check the host's name, or give its address");
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  const addrinfo* chosen = found;
  while (chosen != nullptr && chosen->ai_family != AF_INET) chosen = chosen->ai_next;
  if (chosen == nullptr) chosen = found;
  std::array<char, NI_MAXHOST> digits = {};
  if (::getnameinfo(chosen->ai_addr, chosen->ai_addrlen, digits.data(), digits.size(), nullptr, 0, NI_NUMERICHOST) != 0)
    throw Error(name, fmt::format("the address of the host '{}' cannot be written in digits", place.host), "");
  return digits.data();
}

}  // namespace

struct WebsocketConnection {
  using State = WebsocketClient::State;

  std::string address;
  std::uint16_t port = 0;
  std::string path;
  std::string host_header;
  lws_context* context = nullptr;
  lws* socket = nullptr;  ///< valid if the state is not kClosed
  State state = State::kClosed;
  std::string failure;
  std::string outgoing;  ///< the text to be sent, after LWS_PRE bytes for its header; empty: none
  bool is_ending = false;

  void begin();
  void opened();
  void lost(std::string why);
  /// Returns what libwebsockets expects: 0, or -1 to close the connection.
  int write();
  /// Never waits.
  void serve() const { websockets().service(context, -1); }
};

namespace {

int on_event(lws* socket, lws_callback_reasons reason, void*, void* in, std::size_t bytes) {
  auto& connection = *static_cast<WebsocketConnection*>(websockets().user_of(websockets().context_of(socket)));
  switch (reason) {
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
      connection.opened();
      return 0;
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
      connection.lost(in == nullptr ? "it does not answer" : std::string(static_cast<const char*>(in), bytes));
      return 0;
    case LWS_CALLBACK_CLIENT_CLOSED:
      connection.lost("the connection was closed");
      return 0;
    case LWS_CALLBACK_CLIENT_WRITEABLE:
      return connection.write();
    default:
      return 0;
  }
}

lws_context* make_context(WebsocketConnection& connection) {
  static const lws_protocols protocols[] = {{"", on_event, 0, 0, 0, nullptr, 0},
                                            {nullptr, nullptr, 0, 0, 0, nullptr, 0}};
  constexpr unsigned kDescriptors = 16;  // otherwise it makes room for as many as the system allows
  constexpr unsigned kMostReadAtOnce_bytes = 65536;
  websockets().set_log_level(0, nullptr);
  lws_context_creation_info info = {};
  info.port = CONTEXT_PORT_NO_LISTEN;
  info.protocols = protocols;
  info.timeout_secs = std::chrono::seconds(kServerPatience).count();
  info.fd_limit_per_thread = kDescriptors;
  info.pt_serv_buf_size = kMostReadAtOnce_bytes;
  info.gid = -1;
  info.uid = -1;
  info.user = &connection;
  return websockets().create_context(&info);
}

}  // namespace

void WebsocketConnection::begin() {
  lws_client_connect_info info = {};
  info.context = context;
  info.address = address.c_str();
  info.port = port;
  info.path = path.c_str();
  info.host = host_header.c_str();
  info.ietf_version_or_minus_one = -1;
  info.ssl_connection = LCCSCF_HTTP_NO_FOLLOW_REDIRECT;
  info.pwsi = &socket;
  state = State::kConnecting;
  failure.clear();
  outgoing.clear();
  if (websockets().connect(&info) == nullptr && state == State::kConnecting) lost("it cannot be reached");
}

void WebsocketConnection::opened() {
  state = State::kOpen;
  const unsigned patience_ms = std::chrono::milliseconds(kServerPatience).count();
  ::setsockopt(websockets().descriptor_of(socket), IPPROTO_TCP, TCP_USER_TIMEOUT, &patience_ms, sizeof(patience_ms));
}

void WebsocketConnection::lost(std::string why) {
  if (state == State::kClosed) return;
  state = State::kClosed;
  socket = nullptr;
  if (failure.empty()) failure = std::move(why);
}

int WebsocketConnection::write() {
  if (is_ending) {
    websockets().set_close_reason(socket, LWS_CLOSE_STATUS_NORMAL, nullptr, 0);
    return -1;
  }
  if (outgoing.empty()) return 0;
  auto* const text = reinterpret_cast<unsigned char*>(outgoing.data()) + LWS_PRE;
  const int written = websockets().write(socket, text, outgoing.size() - LWS_PRE, LWS_WRITE_TEXT);
  outgoing.clear();
  return written < 0 ? -1 : 0;
}

WebsocketClient::WebsocketClient(const HostPort& place, std::string path, const std::string& name)
    : connection_(std::make_unique<WebsocketConnection>()) {
  connection_->address = address_of(place, name);
  connection_->port = place.port;
  connection_->path = std::move(path);
  connection_->host_header = host_port_url("ws", place).substr(std::string_view("ws://").size());
  connection_->context = make_context(*connection_);
  if (connection_->context == nullptr) throw Error(name, "libwebsockets could not be started", "free some memory");
  connection_->begin();
}

WebsocketClient::~WebsocketClient() {
  if (state() == State::kOpen) {
    connection_->is_ending = true;
    websockets().ask_to_write(connection_->socket);
    const auto until = Clock::now() + kClosingPatience;
    for (work(); state() == State::kOpen && Clock::now() < until; work()) std::this_thread::sleep_for(kBetweenLooks);
  }
  websockets().destroy_context(connection_->context);
}

WebsocketClient::State WebsocketClient::state() const {
  return connection_->state;
}

const std::string& WebsocketClient::failure() const {
  return connection_->failure;
}

void WebsocketClient::connect() {
  if (state() == State::kClosed) connection_->begin();
}

void WebsocketClient::work() {
  connection_->serve();
}

void WebsocketClient::wait(std::chrono::milliseconds patience) {
  const auto until = Clock::now() + patience;
  for (work(); state() == State::kConnecting && Clock::now() < until; work())
    std::this_thread::sleep_for(kBetweenLooks);
}

bool WebsocketClient::is_free() const {
  if (state() != State::kOpen || websockets().has_rest(connection_->socket) != 0 ||
      websockets().is_choked(connection_->socket) != 0)
    return false;
  int unsent_bytes = 0;
  return ::ioctl(descriptor(), SIOCOUTQNSD, &unsent_bytes) != 0 || unsent_bytes == 0;
}

bool WebsocketClient::send(std::string_view text) {
  WebsocketConnection& connection = *connection_;
  connection.outgoing.assign(LWS_PRE, '\0');
  connection.outgoing += text;
  for (int i = 0; i < kTries && state() == State::kOpen && !connection.outgoing.empty(); ++i) {
    websockets().ask_to_write(connection.socket);
    connection.serve();
  }
  if (state() == State::kOpen && !connection.outgoing.empty()) {
    connection.failure = "it takes no more data";
    websockets().set_timeout(connection.socket, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_SYNC);
  }
  return state() == State::kOpen;
}

int WebsocketClient::descriptor() const {
  return state() == State::kOpen ? websockets().descriptor_of(connection_->socket) : -1;
}

}  // namespace vestige
