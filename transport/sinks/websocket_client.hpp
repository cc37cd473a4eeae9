#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "traces/base/host_port.hpp"

namespace vestige {

struct WebsocketConnection;  ///< in the source file, which alone knows libwebsockets

/// A connection to a websocket server (RFC 6455), without encryption. It sends texts, and ignores what the server
/// sends. Only the constructor, `wait` and the destructor wait for anything. Nothing works on the connection between
/// the calls, so call `work` often. Used by one thread at a time.
class WebsocketClient {
 public:
  enum class State { kClosed, kConnecting, kOpen };

  /// Resolves the host's name, and begins to connect. `path` is what the server is asked for, `name` is for messages.
  /// Throws `Error` if the host is not known.
  WebsocketClient(const HostPort& place, std::string path, const std::string& name);
  /// Tells the server that the connection ends, and waits at most 0.2 s for its answer.
  ~WebsocketClient();
  WebsocketClient(const WebsocketClient&) = delete;
  WebsocketClient& operator=(const WebsocketClient&) = delete;

  State state() const;
  /// Why the connection was not made, or was lost.
  const std::string& failure() const;
  /// Begins to connect, if the connection is closed. If the server does not answer within 3 s, it is closed again.
  void connect();
  /// Does what is due: connects, answers pings, notices that the connection is lost. A connection is lost, too, if the
  /// server takes no bytes for 3 s.
  void work();
  /// Waits at most `patience` until the connection is made or refused.
  void wait(std::chrono::milliseconds patience);
  /// Whether the connection is open, and the network has taken everything that was sent.
  bool is_free() const;
  /// Passes a text to the system. Returns false, and closes the connection, if the system does not take it now.
  bool send(std::string_view text);
  /// A descriptor that becomes readable when `work` is due; -1 if the connection is not open.
  int descriptor() const;

 private:
  std::unique_ptr<WebsocketConnection> connection_;
};

}  // namespace vestige
