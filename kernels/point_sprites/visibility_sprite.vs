vs_1_1
; First pass by point sprites: an opaque square of the size of the surfel's quad, at the centre's depth, moved away from
; the eye by z_t. v0: o; v1.x: 2h. c0..c4 as for visibility.vs; c6.x: eta.

; camera space
dp4 r0.x, v0, c0
dp4 r0.y, v0, c1
dp4 r0.z, v0, c2

; the square's side in pixels
rcp r1.x, r0.z
mul r1.x, r1.x, c6.x
mul oPts.x, r1.x, v1.x

; o (1 + z_t / |o|)
dp3 r0.w, r0, r0
rsq r0.w, r0.w
mul r0.w, r0.w, c4.z
mad r0.xyz, r0.w, r0, r0

; frustum: (x, y, A z + B, z)
mul oPos.xyw, r0.xyzz, c3
mad oPos.z, r0.z, c4.x, c4.y
