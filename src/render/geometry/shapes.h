#pragma once

#include "fluid/triangle_mesh.h"

namespace ebru {

/// Closed meshes in world space, counter-clockwise from outside, for obstacles.

/// An axis-aligned box with flat faces: 24 vertices, 12 triangles.
TriangleMesh makeBox(const Vec3f& centreWorld, const Vec3f& sizeWorld);

/// A sphere of 2 * rings segments around z, with exact normals; its vertices lie on the sphere.
TriangleMesh makeSphere(const Vec3f& centreWorld, float radiusWorld, int rings = 96);

/// A box with an axis-aligned hollow that is open at the top (+z), with flat faces, four of them the rim: 56
/// vertices, 28 triangles.
/// @param outerSizeWorld  of the whole
/// @param thicknessWorld  of walls and floor; below half the width and depth, and below the height
TriangleMesh makeTank(const Vec3f& centreWorld, const Vec3f& outerSizeWorld, float thicknessWorld);

}  // namespace ebru
