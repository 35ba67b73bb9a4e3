vs_1_1
; Visibility splatting like visibility.vs, with the corner o +- s +- t found in the vertex: 12 bytes and 9 slots.

; camera space
dp4 r2.x, v0, c0
dp4 r2.y, v0, c1
dp4 r2.z, v0, c2

; p (1 + z_t / |p|)
dp3 r2.w, r2, r2
rsq r2.w, r2.w
mul r2.w, r2.w, c4.z
mad r2.xyz, r2, r2.w, r2

; frustum: (x, y, A z + B, z)
mul oPos.xyw, r2.xyzz, c3
mad oPos.z, r2.z, c4.x, c4.y
