// SPDX-License-Identifier: Apache-2.0
// A local socket that programs connect to: lines in, lines out, never waited for.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/failure.h"
#include "platform/unique_fd.h"

namespace relievo {

// One thread, any. No verb waits, whatever the clients do. A client that has closed its side is still answered, and
// then let go.
class ControlSocket {
 public:
  static constexpr std::size_t kMostClients = 8;
  static constexpr std::size_t kMostLine = 4096;          // bytes of a client's line, without its end
  static constexpr std::size_t kMostUnread = 256 * 1024;  // bytes that a client leaves unread before it is dropped

  // A stream socket of mode 0600 at `path`, of the user alone from its first moment on. One that nobody listens on is
  // replaced. InvalidState where somebody does, InvalidArgument for a path that is too long or something else than a
  // socket, Io.
  [[nodiscard]] static Outcome<std::unique_ptr<ControlSocket>> listen(const std::string& path);
  // Deletes the socket file, unless another program has replaced it.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  using ClientId = std::uint64_t;  // never used again
  struct Line {
    ClientId client = 0;
    std::string text;
    bool too_long = false;  // then its text is lost
  };

  // Lets clients in and out, takes what they have sent, at most one line's bytes of each, and sends what waits for
  // them. One that comes when there are kMostClients is told `refusal` and let go.
  void attend(std::string_view refusal);
  // The next whole line; clients take turns.
  [[nodiscard]] std::optional<Line> next();
  // False when that client has gone.
  bool send(ClientId client, std::string_view line);
  void sendToAll(std::string_view line);

 private:
  struct Client {
    ClientId id = 0;
    UniqueFd fd;
    std::string in, out;
    bool skipping = false;  // the rest of a line that is too long
    bool ended = false;     // it sends no more
    bool gone = false;
  };
  ControlSocket(UniqueFd fd, std::string path, dev_t device, ino_t inode);
  void accept(std::string_view refusal);
  static void receive(Client& client);
  static void put(Client& client, std::string_view line);
  static void flush(Client& client);
  [[nodiscard]] static std::optional<Line> takeLine(Client& client);

  UniqueFd fd_;
  const std::string path_;
  const dev_t device_;  // of the path, so that another's is left alone
  const ino_t inode_;
  ClientId last_id_ = 0;
  std::size_t turn_ = 0;
  std::vector<Client> clients_;
};

}  // namespace relievo
