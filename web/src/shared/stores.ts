// What a session keeps of people beside their answers.
export interface Stores {
  names: boolean;
  text: boolean;
  questions: boolean;
  query: string[];
  screening: boolean;
  discussion: boolean;
}
