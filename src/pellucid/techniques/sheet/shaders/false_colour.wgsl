// Colours for numbers: black, blue, green, yellow, red, white at 0, 1/5 .. 1, linear between. Twin of reference.py.

fn sheet_false_colour(value: f32) -> vec3f {
    let x = 5.0 * saturate(value);
    let red = saturate(x - 2.0);
    let green = saturate(x - 1.0) - saturate(x - 3.0) + saturate(x - 4.0);
    let blue = saturate(x) - saturate(x - 1.0) + saturate(x - 4.0);
    return vec3f(red, green, blue);
}
