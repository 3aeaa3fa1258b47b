#pragma once

#include "fluid/triangle_mesh.h"

namespace ebru {

/// Closed meshes in world space, counter-clockwise from outside, for obstacles.

/// An axis-aligned box with flat faces: 24 vertices, 12 triangles.
TriangleMesh makeBox(const Vec3f& centreWorld, const Vec3f& sizeWorld);

/// A sphere of 2 * rings segments around z, with exact normals; its vertices lie on the sphere.
TriangleMesh makeSphere(const Vec3f& centreWorld, float radiusWorld, int rings = 96);

}  // namespace ebru
