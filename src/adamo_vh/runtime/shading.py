"""How a surface is shaded, as programs for OpenGL.

Light is computed at the vertices, as in OpenGL's own lighting, and interpolated; the shadow of the
one light that casts some is looked up for each pixel. A second picture, the label of each pixel,
comes out of the same pass: which part it shows, which way the surface faces and how far it is.
"""

from __future__ import annotations

VERTEX = """
#version 120
uniform int lights;
uniform int caster;
uniform mat4 to_shadow;
varying vec3 base;
varying vec3 lit;
varying vec4 place;
varying float facing;

vec3 light(int i, vec3 eye, vec3 normal) {
    vec3 to = normalize(gl_LightSource[i].position.xyz - eye * gl_LightSource[i].position.w);
    float beam = 1.0;
    if (gl_LightSource[i].spotCutoff < 179.0) {
        beam = dot(-to, normalize(gl_LightSource[i].spotDirection));
        beam = beam < gl_LightSource[i].spotCosCutoff
            ? 0.0 : pow(max(beam, 0.0), gl_LightSource[i].spotExponent);
    }
    float diffuse = max(dot(normal, to), 0.0);
    float shine = max(dot(normal, normalize(to + normalize(-eye))), 0.0);
    shine = diffuse > 0.0 ? pow(shine, gl_FrontMaterial.shininess) : 0.0;
    vec3 sum = (gl_LightSource[i].ambient.rgb + diffuse * gl_LightSource[i].diffuse.rgb)
        * gl_Color.rgb;
    return beam * (sum + shine * gl_LightSource[i].specular.rgb * gl_FrontMaterial.specular.rgb);
}

void main() {
    vec4 eye = gl_ModelViewMatrix * gl_Vertex;
    vec3 normal = normalize(gl_NormalMatrix * gl_Normal);
    base = gl_FrontMaterial.emission.rgb;
    lit = vec3(0.0);
    for (int i = 0; i < lights; i++) {
        if (i == caster) lit = light(i, eye.xyz, normal);
        else base += light(i, eye.xyz, normal);
    }
    base = min(base, 1.0);
    lit = min(lit, 1.0);
    place = to_shadow * eye;
    facing = 0.5 + 0.5 * dot(normal, vec3(0.48, 0.62, 0.62));
    gl_FrontColor = gl_Color;
    gl_TexCoord[0] = gl_MultiTexCoord0;
    gl_Position = ftransform();
}
"""

FRAGMENT = """
#version 120
uniform sampler2D picture;
uniform sampler2DShadow shadow;
uniform vec2 part;
varying vec3 base;
varying vec3 lit;
varying vec4 place;
varying float facing;

void main() {
#ifdef SHADOW
    // The map shows what is before the light; behind it nothing is known, and all is lit.
    vec3 colour = base + (place.w > 0.0 ? shadow2DProj(shadow, place).r : 1.0) * lit;
#else
    vec3 colour = base + lit;
#endif
#ifdef TEXTURE
    colour *= texture2D(picture, gl_TexCoord[0].xy).rgb;
#endif
    gl_FragData[0] = vec4(colour, gl_Color.a);
    gl_FragData[1] = vec4(part, facing, 0.5 + 0.1 * log2(gl_FragCoord.w));
}
"""
"""Its second output is the label: the part's number in two bytes, then facing, then distance in
steps of 2.8 %, from a thirtieth of a metre to 32 metres."""


def fragment(*, texture: bool, shadow: bool) -> str:
    """The program of a pixel."""
    chosen = "".join(
        f"#define {name}\n" for name, on in (("TEXTURE", texture), ("SHADOW", shadow)) if on
    )
    return FRAGMENT.lstrip().replace("\n", f"\n{chosen}", 1)
