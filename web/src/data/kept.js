// What the browser keeps for the next visit. Nothing where it keeps nothing, or what another page left is no JSON.
export function kept(key) {
  try {
    return JSON.parse(localStorage.getItem(`kadans.${key}`));
  } catch {
    return null;
  }
}

export function keep(key, value) {
  try {
    localStorage.setItem(`kadans.${key}`, JSON.stringify(value));
  } catch {
    // The page works without.
  }
}
