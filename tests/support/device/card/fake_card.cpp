// SPDX-License-Identifier: Apache-2.0
// The card's life, and what a television sees of it.
#include "tests/support/device/card/fake_card.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "tests/support/device/card/card_state.h"

namespace relievo::test {
namespace {

std::unique_ptr<CardState> card;

// A rectangle of a picture.
void copy(const CardPicture& from, int x, int rows, CardPicture& to, int y) {
  for (int r = 0; r < rows; ++r) {
    const auto source = from.rgba.begin() + (static_cast<std::ptrdiff_t>(r) * from.width + x) * 4;
    std::copy_n(source, to.width * 4, to.rgba.begin() + static_cast<std::ptrdiff_t>(y + r) * to.width * 4);
  }
}

}  // namespace

CardState& theCard() {
  if (card == nullptr) throw std::logic_error("there is no fake card");
  return *card;
}

FakeCard::FakeCard(std::string driver, std::vector<drmModeModeInfo> modes) {
  card = std::make_unique<CardState>();
  char folder[] = "/tmp/fake-card-XXXXXX";
  if (::mkdtemp(folder) == nullptr) throw std::runtime_error("no folder for the fake card");
  card->path = std::string(folder) + "/card0";
  card->driver = std::move(driver);
  card->modes = std::move(modes);
  // A pipe with a name: what is written into it are the kernel's events.
  if (::mkfifo(card->path.c_str(), 0600) != 0) throw std::runtime_error("no pipe for the fake card");
  card->events = UniqueFd(::open(card->path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
}

FakeCard::~FakeCard() {
  ::unlink(card->path.c_str());
  ::rmdir(card->path.substr(0, card->path.rfind('/')).c_str());
  card.reset();
}

void FakeCard::wasUsed(bool keep) {
  card->keeps_left = keep;
  card->left = {{{CardState::kConnector, "HDR_OUTPUT_METADATA"}, 90},
                {{CardState::kConnector, "Colorspace"}, 9},
                {{CardState::kCrtc, "GAMMA_LUT"}, 91},
                {{CardState::kPointer, "FB_ID"}, 92},
                {{CardState::kPointer, "CRTC_ID"}, CardState::kCrtc}};
}
std::vector<std::string> FakeCard::left() const {
  std::vector<std::string> names;
  for (const auto& [property, value] : card->left) {
    if (value != 0) names.push_back(property.second);
  }
  return names;
}

std::string FakeCard::path() const {
  return card->path;
}
const std::optional<drmModeModeInfo>& FakeCard::mode() const {
  return card->mode;
}
int FakeCard::bufferWidth() const {
  return card->pictures.at(card->shown).width;
}
int FakeCard::bufferHeight() const {
  return card->pictures.at(card->shown).height;
}
int FakeCard::rejected() const {
  return card->rejected;
}

CardPicture FakeCard::seen() const {
  const CardPicture& buffer = card->pictures.at(card->shown);
  const drmModeModeInfo& mode = card->mode.value();
  if ((mode.flags & DRM_MODE_FLAG_3D_MASK) != DRM_MODE_FLAG_3D_FRAME_PACKING) return buffer;
  CardPicture sent{mode.hdisplay, mode.vdisplay + mode.vtotal, {}};
  sent.rgba.resize(static_cast<std::size_t>(sent.width) * sent.height * 4);
  if (card->driver != "vc4") {
    copy(buffer, 0, sent.height, sent, 0);
    return sent;
  }
  for (std::size_t i = 3; i < sent.rgba.size(); i += 4) sent.rgba[i] = 255;
  copy(buffer, 0, mode.vdisplay, sent, 0);
  copy(buffer, mode.hdisplay, mode.vdisplay, sent, mode.vtotal);
  return sent;
}

}  // namespace relievo::test
