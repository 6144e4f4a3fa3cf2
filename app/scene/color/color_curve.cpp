// SPDX-License-Identifier: Apache-2.0
#include "app/scene/color/color_curve.h"

#include <algorithm>
#include <limits>

namespace relievo {
namespace {

// BT.709.
constexpr double kRed = 0.2126, kBlue = 0.0722;

// Every fifth of the 256 entries. With straight pieces between them a colour is off by 2.9 of 255 at most (rainbow), an
// inverted entry by 0.6 of 255. Turbo: A. Mikhailov, "Turbo, an improved rainbow colormap for visualization", Google
// 2019. Inferno, magma, plasma, viridis: S. van der Walt and N. Smith 2015, in matplotlib (CC0). Rainbow: matplotlib,
// red |2x - 1/2|, green sin(pi x), blue cos(pi x / 2).
// clang-format off
constexpr std::array<std::uint32_t, 52> kTurbo{0x30123b, 0x36215f, 0x3b2f80, 0x3f3e9c, 0x424bb5, 0x4559cb, 0x4666dd, 0x4773eb, 0x4680f6, 0x458cfd, 0x4099ff, 0x38a5fb, 0x2fb2f4, 0x27bee9, 0x1fc9dd, 0x1ad4d0, 0x18ddc2, 0x1ae4b6, 0x22ebaa, 0x2ff19b, 0x3ff68a, 0x52fa7a, 0x65fd69, 0x79fe59, 0x8bff4b, 0x9cfe40, 0xa9fb39, 0xb7f735, 0xc3f134, 0xd0ea34, 0xdbe236, 0xe5d938, 0xeecf3a, 0xf5c53a, 0xfaba39, 0xfdae35, 0xfea130, 0xfe932a, 0xfc8423, 0xf9751d, 0xf46617, 0xef5811, 0xe84b0c, 0xe14109, 0xd83706, 0xce2d04, 0xc32503, 0xb71d02, 0xa91601, 0x9b0f01, 0x8b0902, 0x7a0403};
constexpr std::array<std::uint32_t, 52> kInferno{0x000004, 0x02020c, 0x050417, 0x0a0722, 0x10092d, 0x160b39, 0x1e0c45, 0x260c51, 0x2f0a5b, 0x380962, 0x400a67, 0x490b6a, 0x510e6c, 0x59106e, 0x61136e, 0x69166e, 0x71196e, 0x781c6d, 0x801f6c, 0x88226a, 0x902568, 0x982766, 0xa02a63, 0xa82e5f, 0xb0315b, 0xb73557, 0xbf3952, 0xc63d4d, 0xcc4248, 0xd34743, 0xd94d3d, 0xdf5337, 0xe45a31, 0xe9612b, 0xed6925, 0xf1711f, 0xf47918, 0xf78212, 0xf98b0b, 0xfa9407, 0xfb9d07, 0xfca60c, 0xfcb014, 0xfbba1f, 0xfac42a, 0xf8cd37, 0xf6d746, 0xf4e156, 0xf2ea69, 0xf2f27d, 0xf5f992, 0xfcffa4};
constexpr std::array<std::uint32_t, 52> kMagma{0x000004, 0x02020b, 0x050416, 0x090720, 0x0e0b2b, 0x140e36, 0x1a1042, 0x21114e, 0x29115a, 0x311165, 0x390f6e, 0x420f75, 0x4a1079, 0x52137c, 0x5a167e, 0x621980, 0x6a1c81, 0x721f81, 0x792282, 0x812581, 0x892881, 0x912b81, 0x992d80, 0xa1307e, 0xaa337d, 0xb2357b, 0xba3878, 0xc23b75, 0xca3e72, 0xd2426f, 0xd9466b, 0xe04c67, 0xe75263, 0xec5860, 0xf1605d, 0xf4695c, 0xf7725c, 0xf97b5d, 0xfb8560, 0xfc8e64, 0xfd9869, 0xfea16e, 0xfeaa74, 0xfeb47b, 0xfebd82, 0xfec68a, 0xfecf92, 0xfed89a, 0xfde2a3, 0xfdebac, 0xfcf4b6, 0xfcfdbf};
constexpr std::array<std::uint32_t, 52> kPlasma{0x0d0887, 0x1b068d, 0x260591, 0x2f0596, 0x38049a, 0x41049d, 0x4903a0, 0x5102a3, 0x5901a5, 0x6100a7, 0x6900a8, 0x7100a8, 0x7801a8, 0x8004a8, 0x8707a6, 0x8e0ca4, 0x9511a1, 0x9c179e, 0xa21d9a, 0xa82296, 0xae2892, 0xb42e8d, 0xba3388, 0xbf3984, 0xc43e7f, 0xc9447a, 0xcd4a76, 0xd24f71, 0xd6556d, 0xda5b69, 0xde6164, 0xe26660, 0xe66c5c, 0xe97257, 0xed7953, 0xf07f4f, 0xf3854b, 0xf58c46, 0xf79342, 0xf99a3e, 0xfba139, 0xfca835, 0xfdaf31, 0xfeb72d, 0xfebe2a, 0xfdc627, 0xfcce25, 0xfbd724, 0xf8df25, 0xf6e826, 0xf3f027, 0xf0f921};
constexpr std::array<std::uint32_t, 52> kViridis{0x440154, 0x46085c, 0x471063, 0x481769, 0x481d6f, 0x482475, 0x472a7a, 0x46307e, 0x453781, 0x433d84, 0x414287, 0x3f4889, 0x3d4e8a, 0x3a538b, 0x38598c, 0x355e8d, 0x33638d, 0x31688e, 0x2e6d8e, 0x2c718e, 0x2a768e, 0x297b8e, 0x27808e, 0x25848e, 0x23898e, 0x218e8d, 0x20928c, 0x1f978b, 0x1e9c89, 0x1fa188, 0x21a585, 0x24aa83, 0x28ae80, 0x2eb37c, 0x35b779, 0x3dbc74, 0x46c06f, 0x50c46a, 0x5ac864, 0x65cb5e, 0x70cf57, 0x7cd250, 0x89d548, 0x95d840, 0xa2da37, 0xb0dd2f, 0xbddf26, 0xcae11f, 0xd8e219, 0xe5e419, 0xf1e51d, 0xfde725};
constexpr std::array<std::uint32_t, 52> kRainbow{0x8000ff, 0x7610ff, 0x6c1fff, 0x622ffe, 0x583efd, 0x4e4dfc, 0x445cfb, 0x396bf9, 0x3079f7, 0x2686f5, 0x1c93f3, 0x11a0f1, 0x08acee, 0x02b7eb, 0x0dc2e8, 0x17cbe4, 0x20d5e1, 0x2adddd, 0x34e4d9, 0x3febd5, 0x48f1d0, 0x52f5cb, 0x5df9c7, 0x66fcc2, 0x70febc, 0x7affb7, 0x84ffb2, 0x8efeac, 0x99fca6, 0xa2f9a0, 0xacf59a, 0xb6f193, 0xc0eb8d, 0xcbe486, 0xd4dd80, 0xded579, 0xe8cb72, 0xf2c26b, 0xfcb763, 0xffac5c, 0xffa055, 0xff934d, 0xff8646, 0xff793e, 0xff6b37, 0xff5c2f, 0xff4d27, 0xff3e1f, 0xff2f18, 0xff1f10, 0xff1008, 0xff0000};
// clang-format on
// As in OpenCV and MATLAB; matplotlib's knots are elsewhere by up to 0.025.
constexpr std::array<std::uint32_t, 9> kJet{0x000080, 0x0000ff, 0x0080ff, 0x00ffff, 0x80ff80,
                                            0xffff00, 0xff8000, 0xff0000, 0x800000};
// ColorBrewer's, from blue to red: matplotlib's Spectral_r.
constexpr std::array<std::uint32_t, 11> kSpectral{0x5e4fa2, 0x3387bc, 0x66c2a5, 0xaadca4, 0xe6f598, 0xfffebe,
                                                  0xfee08b, 0xfdad60, 0xf46d43, 0xd53e4f, 0x9e0142};
// ColorBrewer's, from yellow to blue: matplotlib's YlGnBu.
constexpr std::array<std::uint32_t, 9> kYlGnBu{0xffffd9, 0xedf8b1, 0xc7e9b4, 0x7fcdbb, 0x41b6c4,
                                               0x1d91c0, 0x225ea8, 0x253494, 0x081d58};
// Black, blue, cyan, white: s is the mean of red, green and blue, as viewers of such Kinect films read it (three.js).
constexpr std::array<std::uint32_t, 4> kKinect{0x000000, 0x0000ff, 0x00ffff, 0xffffff};
constexpr std::array<std::uint32_t, 7> kHue{0xff0000, 0xffff00, 0x00ff00, 0x00ffff, 0x0000ff, 0xff00ff, 0xff0000};

YuvColor colorOf(std::uint32_t knot) noexcept {
  const auto part = [knot](int shift) { return (knot >> shift & 0xffU) / 255.0; };
  return toYuv(part(16), part(8), part(0));
}
YuvColor minus(const YuvColor& a, const YuvColor& b) noexcept {
  return {a.y - b.y, a.u - b.u, a.v - b.v};
}
float dot(const YuvColor& a, const YuvColor& b) noexcept {
  return a.y * b.y + a.u * b.u + a.v * b.v;
}

template <const auto& kKnots>
const ColorCurve& made() {
  static const ColorCurve curve(kKnots);
  return curve;
}

}  // namespace

YuvColor toYuv(double red, double green, double blue) noexcept {
  const double y = kRed * red + (1 - kRed - kBlue) * green + kBlue * blue;
  return {static_cast<float>(y), static_cast<float>((blue - y) / (2 * (1 - kBlue))),
          static_cast<float>((red - y) / (2 * (1 - kRed)))};
}

ColorCurve::ColorCurve(std::span<const std::uint32_t> knots) : closed_(knots.front() == knots.back()) {
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const YuvColor from = colorOf(knots[i]), along = minus(colorOf(knots[i + 1]), from);
    const float per = 1 / dot(along, along);
    pieces_.push_back({from, along, {along.y * per, along.u * per, along.v * per}});
  }
  per_piece_ = 1 / static_cast<float>(pieces_.size());
  using Four = float __attribute__((vector_size(16)));  // by an extension that GCC and clang share
  constexpr Four kBegin{}, kEnd{1, 1, 1, 1};
  // The number of the piece nearest to each of four colours that differ in v; as placeOn.
  const auto nearestPieces = [&](float y, float u, const Four& v) {
    Four least = kBegin + std::numeric_limits<float>::infinity(), nearest{};
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const auto& [from, along, per] = pieces_[k];
      const float off_y = y - from.y, off_u = u - from.u;
      const Four off_v = v - from.v, t = off_y * per.y + off_u * per.u + off_v * per.v;
      const Four on = t < kBegin ? kBegin : t > kEnd ? kEnd : t;
      const Four left_y = off_y - on * along.y, left_u = off_u - on * along.u, left_v = off_v - on * along.v;
      const Four distance2 = left_y * left_y + left_u * left_u + left_v * left_v;
      nearest = distance2 < least ? kBegin + static_cast<float>(k) : nearest;
      least = distance2 < least ? distance2 : least;
    }
    return nearest;
  };
  constexpr auto middleOf = [](int place) { return (static_cast<float>(place) + 0.5F) / kSide; };
  std::size_t cell = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int u = 0; u < kSide; ++u) {
      for (int v = 0; v < kSide; v += 4) {
        const Four four{middleOf(v), middleOf(v + 1), middleOf(v + 2), middleOf(v + 3)};
        const Four pieces = nearestPieces(middleOf(y), middleOf(u) - 0.5F, four - 0.5F);
        for (int i = 0; i < 4; ++i) nearest_piece_[cell++] = static_cast<std::uint8_t>(pieces[i]);
      }
    }
  }
}

ColorCurve::Line ColorCurve::lineOf(int k) const noexcept {
  const Piece& piece = pieces_[static_cast<std::size_t>(k)];
  const YuvColor& per = piece.per_length;
  return {{per.y * per_piece_, per.u * per_piece_, per.v * per_piece_},
          (static_cast<float>(k) - dot(piece.from, per)) * per_piece_};
}

double ColorCurve::meanPerColor() const noexcept {
  double sum = 0;
  for (const Piece& piece : pieces_) sum += 1 / std::sqrt(static_cast<double>(dot(piece.along, piece.along)));
  return sum / (static_cast<double>(pieces_.size()) * static_cast<double>(pieces_.size()));
}

ColorCurve::Between ColorCurve::between(const YuvColor& color, float low, float high) const RELIEVO_RT {
  const auto weighted = [](const YuvColor& a, const YuvColor& b) {
    return a.y * b.y + kChromaWeight * (a.u * b.u + a.v * b.v);
  };
  const auto count = static_cast<float>(pieces_.size());
  const float from = low * count, to = high * count;
  Between best{low, std::numeric_limits<float>::infinity()};
  for (auto k = static_cast<std::size_t>(from); k < pieces_.size() && static_cast<float>(k) <= to; ++k) {
    const auto first = static_cast<float>(k);
    const YuvColor off = minus(color, pieces_[k].from), &along = pieces_[k].along;
    const float t = std::clamp(weighted(off, along) / weighted(along, along), std::max(from - first, 0.0F),
                               std::min(to - first, 1.0F));
    const YuvColor left{off.y - t * along.y, off.u - t * along.u, off.v - t * along.v};
    const float error = weighted(left, left);
    if (error < best.error) best = {(first + t) * per_piece_, error};
  }
  return best;
}

YuvColor ColorCurve::at(double s) const RELIEVO_RT {
  const double place = std::clamp(s, 0.0, 1.0) * static_cast<double>(pieces_.size());
  const std::size_t k = std::min(static_cast<std::size_t>(place), pieces_.size() - 1);
  const Piece& piece = pieces_[k];
  const auto t = static_cast<float>(place - static_cast<double>(k));
  return {piece.from.y + t * piece.along.y, piece.from.u + t * piece.along.u, piece.from.v + t * piece.along.v};
}

YuvColor ColorCurve::slopeAt(float s) const RELIEVO_RT {
  const auto count = static_cast<float>(pieces_.size());
  const YuvColor& along = pieces_[std::min(static_cast<std::size_t>(s * count), pieces_.size() - 1)].along;
  return {along.y * count, along.u * count, along.v * count};
}

const ColorCurve& curveOf(DepthCode code) {
  switch (code) {
    case DepthCode::Luma:
    case DepthCode::Hue:
      return made<kHue>();
    case DepthCode::Turbo:
      return made<kTurbo>();
    case DepthCode::Jet:
      return made<kJet>();
    case DepthCode::Inferno:
      return made<kInferno>();
    case DepthCode::Magma:
      return made<kMagma>();
    case DepthCode::Viridis:
      return made<kViridis>();
    case DepthCode::Plasma:
      return made<kPlasma>();
    case DepthCode::Rainbow:
      return made<kRainbow>();
    case DepthCode::Spectral:
      return made<kSpectral>();
    case DepthCode::Kinect:
      return made<kKinect>();
    case DepthCode::YlGnBu:
      return made<kYlGnBu>();
  }
  return made<kHue>();
}

}  // namespace relievo
