// What the page remembers of a person's choices. Cookies too: the server has another port each time, and only cookies
// are the same for all ports.

export function recall(name: string): string | null {
  const cookie = document.cookie.split("; ").find((each) => each.startsWith(`${name}=`));
  if (cookie) return decodeURIComponent(cookie.slice(name.length + 1));
  try {
    return localStorage.getItem(name);
  } catch {
    return null;  // a page from a file may have no memory
  }
}

export function remember(name: string, value: string): void {
  const year = 365 * 24 * 3600;
  document.cookie = `${name}=${encodeURIComponent(value)}; max-age=${year}; path=/; SameSite=Strict`;
  try {
    localStorage.setItem(name, value);
  } catch {
    // it will be asked again
  }
}
