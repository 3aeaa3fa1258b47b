#include "texturing/particles/texture_particles.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.h"
#include "surface/poisson_sampling.h"
#include "textures.h"
#include "texturing/particles/texture_transport.h"
#include "zoo.h"

namespace ebru {
namespace {

Mat2f rotation(float angle) {
  return Eigen::Rotation2Df(angle).toRotationMatrix();
}

Mat2f matrix(float a, float b, float c, float d) {
  Mat2f m;
  m << a, b, c, d;
  return m;
}

// max(s1, 1/s2): how much the texture is squeezed or stretched in the worst direction.
TEST(Distortion, OfKnownSingularValues) {
  for (const float angle : {0.0f, 0.4f, -2.0f})
    for (const float other : {0.0f, 1.3f}) {
      EXPECT_NEAR(distortion(rotation(angle)), 1.0f, 1e-4f);
      EXPECT_NEAR(distortion(rotation(angle) * matrix(3, 0, 0, 0.8f) * rotation(other)), 3.0f, 1e-4f);
      EXPECT_NEAR(distortion(rotation(angle) * matrix(0.25f, 0, 0, 1) * rotation(other)), 4.0f, 1e-3f);
      EXPECT_NEAR(distortion(rotation(angle) * matrix(2, 0, 0, -2) * rotation(other)), 2.0f, 1e-3f);
    }
}

// Simple shear by k: singular values k/2 +- sqrt(1 + k^2/4), each the other's inverse.
TEST(Distortion, OfSimpleShear) {
  for (const float k : {0.1f, 1.0f, 3.0f})
    EXPECT_NEAR(distortion(matrix(1, k, 0, 1)), 0.5f * k + std::sqrt(1.0f + 0.25f * k * k),
                1e-4f * (1.0f + k));
}

TEST(Distortion, OfACollapsedTextureIsFinite) {
  EXPECT_GT(distortion(Mat2f::Zero()), 1e5f);
  EXPECT_TRUE(std::isfinite(distortion(Mat2f::Zero())));
  EXPECT_TRUE(std::isfinite(distortion(matrix(1, 1, 1, 1))));
}

// The polar factor of R S with S symmetric positive definite is R.
TEST(NearestRotation, IsThePolarFactor) {
  for (const float angle : {0.0f, 0.9f, 3.0f, -1.5f}) {
    const Mat2f r = rotation(angle);
    EXPECT_LT((nearestRotation(r) - r).norm(), 1e-6f);
    EXPECT_LT((nearestRotation(r * matrix(3, 0.5f, 0.5f, 0.4f)) - r).norm(), 1e-5f);
  }
  for (const Mat2f& m : {matrix(1, 0, 0, -1), matrix(0, 0, 0, 0), matrix(0, 1, 1, 0)})
    EXPECT_NEAR(nearestRotation(m).determinant(), 1.0f, 1e-5f) << "a rotation whatever comes";
}

TEST(LocalTexels, AreTheFramesCoordinates) {
  const TextureParticles particles = test::particlesOnTop(0.05f, 0.1f);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3f& o = particles.orientation[i];
    const Vec3f p = particles.position[i] + 0.05f * (2.0f * o + 3.0f * secondAxis(Vec3f::UnitZ(), o));
    EXPECT_LT((localTexels(particles, i, p, 0.05f) - Vec2f(2.0f, 3.0f)).norm(), 1e-4f);
  }
}

// On an axis-aligned face the box projection is an isometry that is not mirrored (a rotation in an image-like
// frame), and its Jacobian is the derivative of its coordinate.
TEST(BoxProjection, IsIsometricOnFaces) {
  constexpr float texel = 0.1f;
  for (int face = 0; face < 6; ++face) {
    SCOPED_TRACE(face);
    const Vec3f normal = (face % 2 ? -1.0f : 1.0f) * Vec3f::Unit(face / 2);
    Vec3f tangent, bitangent;
    completeFrame(normal, tangent, bitangent);
    for (const float angle : {0.0f, 0.8f, 2.5f}) {
      TextureParticles p;
      p.append(1);
      p.position[0] = Vec3f(0.3f, -0.7f, 1.1f);
      p.normal[0] = normal;
      p.orientation[0] = std::cos(angle) * tangent + std::sin(angle) * bitangent;
      boxProjection(p.position[0], normal, p.orientation[0], texel, p.st[0], p.jacobian[0]);
      EXPECT_NEAR(p.jacobian[0].determinant(), 1.0f, 1e-5f) << "mirrored or scaled";
      EXPECT_LT((p.jacobian[0] * p.jacobian[0].transpose() - Mat2f::Identity()).norm(), 1e-5f);
      const Vec3f other = p.position[0] + 0.4f * tangent - 0.9f * bitangent;
      Vec2f st;
      Mat2f unused;
      boxProjection(other, normal, p.orientation[0], texel, st, unused);
      EXPECT_LT((st - p.st[0] - p.jacobian[0] * localTexels(p, 0, other, texel)).norm(), 1e-3f);
    }
  }
}

// Seen from the front (along +y) a front face has u to the right (+x) and v down (-z).
TEST(BoxProjection, LaysFacesUpright) {
  Vec2f a, right, down;
  Mat2f unused;
  const Vec3f front = -Vec3f::UnitY(), p(0.2f, -0.5f, 0.3f);
  boxProjection(p, front, Vec3f::UnitX(), 0.1f, a, unused);
  boxProjection(p + Vec3f(0.1f, 0.0f, 0.0f), front, Vec3f::UnitX(), 0.1f, right, unused);
  boxProjection(p - Vec3f(0.0f, 0.0f, 0.1f), front, Vec3f::UnitX(), 0.1f, down, unused);
  EXPECT_LT((right - a - Vec2f(1.0f, 0.0f)).norm(), 1e-4f);
  EXPECT_LT((down - a - Vec2f(0.0f, 1.0f)).norm(), 1e-4f);
}

// A normal tilted by a foreshortens one direction to cos a: distortion 1 / cos a.
TEST(BoxProjection, DistortsByTheTilt) {
  Vec2f st;
  Mat2f jacobian;
  const float a = 0.6f;
  boxProjection(Vec3f::Zero(), Vec3f(std::sin(a), 0.0f, std::cos(a)), Vec3f::UnitY(), 0.1f, st, jacobian);
  EXPECT_NEAR(distortion(jacobian), 1.0f / std::cos(a), 1e-4f);
}

TEST(TextureParticles, IdsAreNeverUsedTwice) {
  TextureParticles p;
  EXPECT_EQ(p.append(3), 0u);
  p.reorder({2, 0});
  EXPECT_EQ(p.id, (std::vector<std::uint32_t>{2, 0}));
  EXPECT_EQ(p.append(2), 2u);
  EXPECT_EQ(p.id, (std::vector<std::uint32_t>{2, 0, 3, 4}));
}

TEST(TextureParticles, AStateBringsEverythingBack) {
  const test::Folder folder;
  TextureParticles p = test::particlesOnTop(0.05f, 0.2f);
  p.age[3] = 7.0f;
  p.reorder({3, 1, 2});
  const std::string bytes = test::stateOf(p, folder / "a.state");
  TextureParticles loaded;
  loaded.load(StateReader(folder / "a.state", "test"));
  EXPECT_EQ(loaded.size(), 3u);
  EXPECT_EQ(loaded.age[0], 7.0f);
  EXPECT_EQ(loaded.nextId, p.nextId);
  EXPECT_EQ(test::stateOf(loaded, folder / "b.state"), bytes);
}

// 0.7 particles per squared Poisson spacing of 0.82 texel.
TEST(ParticleCount, TooManySaysHowManyAndWhatWouldDo) {
  const auto frame = zoo::still().frames[0];
  constexpr float texel = 1e-8f;
  const double spacing = 0.82 * static_cast<double>(texel);
  const std::string count =
      fmt::format("{:.3g} particles", 0.7 * surfaceArea(frame->mesh) / (spacing * spacing));
  std::string message;
  try {
    checkParticleCount(*frame, texel);
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find(count), std::string::npos) << message << "\nwants: " << count;
  EXPECT_NE(message.find("texture.texel_size"), std::string::npos) << message;
  EXPECT_NE(message.find(frame->source), std::string::npos) << message;
  const std::size_t at = message.find("at least ");
  ASSERT_NE(at, std::string::npos) << message;
  const float suggested = std::strtof(message.c_str() + at + 9, nullptr);
  EXPECT_GT(suggested, texel);
  EXPECT_NO_THROW(checkParticleCount(*frame, suggested)) << "what it proposes has to do";
}

TEST(ParticleCount, OfAReasonableFrameOrNone) {
  EXPECT_NO_THROW(checkParticleCount(*zoo::still().frames[0], 0.01f));
  EXPECT_NO_THROW(checkParticleCount(*zoo::empty().frames[0], 1e-9f));
}

}  // namespace
}  // namespace ebru
