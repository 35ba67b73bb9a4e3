vs_1_1
; Second pass by point sprites: a circle as wide as the splat would be if its surfel faced the eye, with the low-pass
; filter's pixel. v0: o; v1: r = sigma h, s_k/(2 pi); v2: w_k. c0..c4 as for splat_ewa.vs; c5: 2 sqrt(2c), 1; c6.x: eta.

; camera space
dp4 r0.x, v0, c0
dp4 r0.y, v0, c1
dp4 r0.z, v0, c2

; variance (r eta/z)^2 + 1 in pixels, one over its root, and the side of the square
rcp r1.x, r0.z
mul r1.x, r1.x, c6.x
mul r1.x, r1.x, v1.x
mad r1.y, r1.x, r1.x, c5.y
rsq r1.z, r1.y
mul r1.w, r1.y, r1.z
mul oPts.x, r1.w, c5.x

; frustum: (x, y, A z + B, z)
mul oPos.xyw, r0.xyzz, c3
mad oPos.z, r0.z, c4.x, c4.y

; s_k / (2 pi variance), colour
mul r1.z, r1.z, r1.z
mul oD0.w, r1.z, v1.y
mov oD0.xyz, v2
