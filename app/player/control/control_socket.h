// SPDX-License-Identifier: Apache-2.0
// A local socket that programs connect to. It exchanges lines and never waits.
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

// Use from one thread. No call waits, whatever the clients do. A client that has closed its sending side is still
// answered, then disconnected.
class ControlSocket {
 public:
  static constexpr std::size_t kMostClients = 8;
  static constexpr std::size_t kMostLine = 4096;          // bytes of a client's line, without its end
  static constexpr std::size_t kMostUnread = 256 * 1024;  // bytes that a client leaves unread before it is dropped

  // Listens on a stream socket of mode 0600 at `path`, accessible only to the user from its creation on. A socket on
  // which nobody listens is replaced. InvalidState if somebody does, InvalidArgument if the path is too long or is
  // something other than a socket, Io.
  [[nodiscard]] static Outcome<std::unique_ptr<ControlSocket>> listen(const std::string& path);
  // Deletes the socket file, unless another program has replaced it.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  using ClientId = std::uint64_t;  // never used again
  struct Line {
    ClientId client = 0;
    std::string text;
    bool too_long = false;  // its text is lost
  };

  // Accepts and drops clients, receives at most one line's bytes from each, and sends queued bytes. For a client beyond
  // kMostClients, the one that has been silent longest gets `refusal` and is disconnected; if all have just spoken, the
  // new one.
  void attend(std::string_view refusal);
  // The next whole line; clients take turns.
  [[nodiscard]] std::optional<Line> next();
  // False if that client has disconnected.
  bool send(ClientId client, std::string_view line);
  void sendToAll(std::string_view line);

 private:
  struct Client {
    ClientId id = 0;
    UniqueFd fd;
    std::string in, out;
    bool skipping = false;  // skips the rest of a line that is too long
    bool ended = false;     // it sends no more
    bool gone = false;
    std::uint64_t heard = 0;  // the round in which it connected or last sent something
  };
  ControlSocket(UniqueFd fd, std::string path, dev_t device, ino_t inode);
  void accept(std::string_view refusal);
  [[nodiscard]] bool makeRoom(std::string_view refusal);
  void receive(Client& client) const;
  static void put(Client& client, std::string_view line);
  static void flush(Client& client);
  [[nodiscard]] static std::optional<Line> takeLine(Client& client);

  UniqueFd fd_;
  const std::string path_;
  const dev_t device_;  // of the path, so that another program's socket is left alone
  const ino_t inode_;
  ClientId last_id_ = 0;
  std::uint64_t round_ = 0;
  std::size_t turn_ = 0;
  std::vector<Client> clients_;
};

}  // namespace relievo
