vs_1_1
; Visibility splatting (Ren 2002, section 5.1): an opaque quad of side 2h about the surfel, moved away from the eye
; by z_t along the viewing ray of each corner. Inputs and constants: programs.h.

; corner p = o + y0 s + y1 t in object space, y in {-1, 1}^2
mad r0.xy, v3, c5.z, c5.w
mov r1, v0
mad r1.xyz, r0.x, v1, r1
mad r1.xyz, r0.y, v2, r1

; camera space
dp4 r2.x, r1, c0
dp4 r2.y, r1, c1
dp4 r2.z, r1, c2

; p (1 + z_t / |p|)
dp3 r2.w, r2, r2
rsq r2.w, r2.w
mul r2.w, r2.w, c4.z
mad r2.xyz, r2, r2.w, r2

; frustum: (x, y, A z + B, z)
mul oPos.xyw, r2.xyzz, c3
mad oPos.z, r2.z, c4.x, c4.y
