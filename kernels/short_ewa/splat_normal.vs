vs_1_1
; The EWA filter in 37 slots from vertices of 40 bytes: splat_plane.vs, with what its vertices repeat computed here.
; Inputs and constants: programs.h; the mathematics: README.md.

; o and n in camera space, x and y times eta: r0 = (eta x, eta y, z, z), r1 = (eta n_x, eta n_y, n_z, G = -eta^2 n.o)
dp4 r0.x, v0, c0
dp4 r0.y, v0, c1
dp4 r0.zw, v0, c2
dp3 r1.x, v1, c0
dp3 r1.y, v1, c1
dp3 r1.z, v1, c2
mul r2.xyz, r1, c7.xxy
dp3 r1.w, r0, r2

; r4 = (a, b, -1/near, 1): the surfel's centre on the screen, o/z
mad r2.w, r0.z, r0.z, c5.w
rsq r3.w, r2.w
mad r4, r0, r3.w, c5.xxyx

; W = eta^2 I + a a^T - f f^T + (z/r)^2 I, as (W11, W22, W12), with f = n_xy - n_z a
mad r5.xy, r1.z, -r4, r1
mad r6.xyz, r4.xyxw, r4.xyyw, c5.zzxx
mad r6.xyz, -r5.xyxx, r5.xyyy, r6
rcp r3.x, v4.x
mul r3.x, r3.x, r3.x
mad r6.xy, r2.w, r3.x, r6

; L with L L^T = W
rsq r7.x, r6.x
mul r8.xy, r6.xzzz, r7.x
mad r7.y, -r8.y, r8.y, r6.y
max r7.y, r7.y, c6.x            ; rounding can make it 0 or less where a huge surfel is seen edge-on
rsq r7.y, r7.y

; (r y, 0, 1)
mad r2, v3, c8.xxwz, c8.yyww
mul r2.xy, r2, v4.x

; d = L r y, all over l22: (d_x, d_y, 1, 0)/l22
mul r9, r7.y, r2.xxwz
mad r9.xy, r8, r9, r2.zyyy

; onto the plane of the surfel
dp4 r10.x, r1, r9.xywz
mul r10.y, r1.w, r3.w
mul r9, r9, r10.y
mad r11, r4, r10.x, r9
mul r11, r11, r10.y            ; seen from behind, G and all of r11 are negative
mul oPos, r11, c4

; s_k / (2 pi r0 r1), colour, texture coordinates
max r9.z, r9.z, -r9.z
mul r7.x, r7.x, v4.y
dst r8, r9.z, r7.x
mul oD0, v5, r8.xxxy
mov oT0.xy, v3
